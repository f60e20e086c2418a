"""The data set over processes of a Dask cluster: python dask_frames.py OUT [FRAMES] [WORKERS]

Each worker makes the scene once and keeps its renderer; a task is a run of frames, named by its
seeds, so it can be done anywhere, and again: a worker that dies loses nothing. Frames are those of
one process, byte for byte. On a cluster, give Client the scheduler's address.
"""

import sys
from functools import cache
from pathlib import Path

import basrelief
import data_set
import numpy as np
from distributed import Client, LocalCluster, as_completed

AT_ONCE = 8


@cache
def renderer():
    """This worker's: one thread, since there are as many workers as processors."""
    scene = data_set.scene(np.random.default_rng(0))
    return basrelief.Renderer(scene, filter="trilinear", threads=1)


def draw(first, end, out):
    """Writes the frames of some seeds; a file appears under its name when it is whole."""
    for seed in range(first, end):
        path = Path(out) / f"{seed:06}.npz"
        part = path.with_suffix(".part")
        with part.open("wb") as file:
            np.savez(file, **data_set.frame(renderer(), seed))
        part.replace(path)
    return end - first


def main(out, num="64", workers="2"):
    Path(out).mkdir(parents=True, exist_ok=True)
    num = int(num)
    firsts = range(0, num, AT_ONCE)
    with LocalCluster(int(workers), threads_per_worker=1, dashboard_address=None) as cluster:
        with Client(cluster) as client:
            client.upload_file(data_set.__file__)
            client.upload_file(__file__)
            ends = [min(first + AT_ONCE, num) for first in firsts]
            tasks = client.map(draw, firsts, ends, [str(out)] * len(ends), pure=False)
            done = 0
            for _, drawn in as_completed(tasks, with_results=True):
                done += drawn
                print(f"{done} of {num} frames", end="\r")
    print(f"{out}: {num} frames")


if __name__ == "__main__":
    main(*sys.argv[1:])
