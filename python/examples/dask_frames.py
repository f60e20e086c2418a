"""The data set over processes of a Dask cluster: python dask_frames.py OUT [FRAMES] [WORKERS]

Each worker makes the scene once and keeps its renderer; a task is a run of frames, named by its
seeds, so it can be done anywhere, and again: a worker that dies loses nothing. Frames are those of
one process, byte for byte. On a cluster, give Client the scheduler's address.

--kill-one kills a worker when half of the frames are there; --check draws all of them once more in
this process and compares the bytes; --unlit leaves out light, which takes most of a frame's time.
"""

import argparse
import os
import signal
import time
from functools import cache
from pathlib import Path

import basrelief
import data_set
import numpy as np
from distributed import Client, LocalCluster, as_completed

AT_ONCE = 8


@cache
def renderer(lighting="lit"):
    """This process's: one thread, since there are as many workers as processors."""
    scene = data_set.scene(np.random.default_rng(0))
    return basrelief.Renderer(scene, filter="trilinear", lighting=lighting, threads=1)


def draw(first, end, out, lighting="lit"):
    """Writes the frames of some seeds; a file appears under its name when it is whole."""
    for seed in range(first, end):
        path = Path(out) / f"{seed:06}.npz"
        # A task may be done twice at once, where a worker is thought dead and is not.
        part = path.with_suffix(f".{os.getpid()}.part")
        with part.open("wb") as file:
            np.savez(file, **data_set.frame(renderer(lighting), seed))
        part.replace(path)
    return end - first


def run(out, num, workers, lighting="lit", kills=False):
    """Draws frames on a cluster of this machine's, of which one worker may be killed half way."""
    firsts = range(0, num, AT_ONCE)
    ends = [min(first + AT_ONCE, num) for first in firsts]
    with LocalCluster(workers, threads_per_worker=1, dashboard_address=None) as cluster:
        with Client(cluster) as client:
            for module in [data_set.__file__, __file__]:
                client.upload_file(module)
            others = [[value] * len(ends) for value in (str(out), lighting)]
            done = 0
            # Nobody keeps the tasks: those that are done are not done again for a worker that died.
            tasks = as_completed(
                client.map(draw, firsts, ends, *others, pure=False), with_results=True
            )
            for _, drawn in tasks:
                done += drawn
                if kills and 2 * done >= num:
                    victim = next(iter(client.run(os.getpid).values()))
                    os.kill(victim, signal.SIGKILL)
                    print(f"killed worker {victim} after {done} frames")
                    kills = False
    return done


def check(out, num, lighting="lit"):
    """Compares the files with frames of this process."""
    for seed in range(num):
        wanted = data_set.frame(renderer(lighting), seed)
        with np.load(Path(out) / f"{seed:06}.npz") as found:
            is_same = set(found) == set(wanted) and all(
                found[name].tobytes() == wanted[name].tobytes() for name in wanted
            )
        if not is_same:
            raise SystemExit(f"frame {seed} is not that of one process")


def timed(what, num, work):
    start = time.perf_counter()
    work()
    took = time.perf_counter() - start
    print(f"{num} frames {what} in {took:.1f} s, {took * 1000 / num:.2f} ms each")


def main():
    about, options = __doc__.split("\n\n", 1)
    parser = argparse.ArgumentParser(description=about.split(":")[0], epilog=options)
    parser.add_argument("out", type=Path)
    parser.add_argument("frames", type=int, nargs="?", default=64)
    parser.add_argument("workers", type=int, nargs="?", default=2)
    parser.add_argument("--unlit", action="store_true")
    parser.add_argument("--kill-one", action="store_true")
    parser.add_argument("--check", action="store_true")
    args = parser.parse_args()
    args.out.mkdir(parents=True, exist_ok=True)
    num, lighting = args.frames, "unlit" if args.unlit else "lit"
    cluster = lambda: run(args.out, num, args.workers, lighting, args.kill_one)
    timed(f"by {args.workers} workers", num, cluster)
    if args.check:
        timed("by one process, with the same bytes", num, lambda: check(args.out, num, lighting))


if __name__ == "__main__":
    main()
