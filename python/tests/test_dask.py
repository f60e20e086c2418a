"""Frames of a Dask cluster's processes are those of one process, and a killed worker loses none."""

import os
import signal
import sys
from pathlib import Path

import numpy as np
import pytest

distributed = pytest.importorskip("distributed")

sys.path.insert(0, str(Path(__file__).parent.parent / "examples"))


def test_a_killed_worker_loses_nothing(tmp_path):
    import dask_frames
    import data_set

    num, at_once = 24, dask_frames.AT_ONCE // 4
    with distributed.LocalCluster(3, threads_per_worker=1, processes=True, dashboard_address=None) as cluster:
        with distributed.Client(cluster) as client:
            for module in [data_set, dask_frames]:
                client.upload_file(module.__file__)
            firsts = list(range(0, num, at_once))
            ends = [first + at_once for first in firsts]
            tasks = client.map(dask_frames.draw, firsts, ends, [str(tmp_path)] * len(ends), pure=False)
            finished = distributed.as_completed(tasks)
            next(finished)
            victim = next(iter(client.run(os.getpid).values()))
            os.kill(victim, signal.SIGKILL)
            assert sum(client.gather(tasks)) == num
    own = dask_frames.renderer()
    for seed in range(num):
        wanted = data_set.frame(own, seed)
        with np.load(tmp_path / f"{seed:06}.npz") as found:
            assert set(found) == set(wanted)
            assert all(found[name].tobytes() == wanted[name].tobytes() for name in wanted), seed
