"""Renderers work in processes that were forked or spawned, and pools are made only where frames are."""

import hashlib
import multiprocessing
import os
import subprocess
import sys
import threading
import time

import pytest
from conftest import LAYERS, floor_and_body

import basrelief

CODE = """
import sys, threading, time
start = time.perf_counter()
import basrelief
took = time.perf_counter() - start
assert "basrelief._native" in sys.modules
tasks = len(__import__("os").listdir("/proc/self/task")) if sys.platform == "linux" else 0
print(took, tasks)
"""


def digest(renderer, camera):
    frame = renderer.render(camera, (48, 32), LAYERS)
    return hashlib.sha256(b"".join(array.tobytes() for array in frame.values())).hexdigest()


def of_its_own(camera):
    """The picture of a process that makes all of its own."""
    return digest(basrelief.Renderer(floor_and_body(), threads=2), camera)


def test_importing_is_fast_and_makes_no_threads():
    took, tasks = min(
        tuple(map(float, subprocess.check_output([sys.executable, "-c", CODE]).split())) for _ in range(3)
    )
    # Goal: 0.3 s. NumPy itself is most of it; machines of tests are busy.
    assert took < 1.5
    own = subprocess.check_output(
        [sys.executable, "-c", "import numpy, os; print(len(os.listdir('/proc/self/task')))"]
    ) if sys.platform == "linux" else 0
    assert tasks <= int(own)


@pytest.mark.skipif(not hasattr(os, "fork"), reason="this system has no fork")
@pytest.mark.filterwarnings("ignore:.*fork.*:DeprecationWarning")
def test_a_renderer_goes_on_after_a_fork(scene, cameras):
    renderer = basrelief.Renderer(scene, threads=2)
    wanted = [digest(renderer, camera) for camera in cameras]
    context = multiprocessing.get_context("fork")
    global forked
    forked = renderer
    with context.Pool(2) as pool:
        assert pool.map_async(_of_parent, cameras).get(timeout=60) == wanted
    assert [digest(renderer, camera) for camera in cameras] == wanted


forked = None


def _of_parent(camera):
    return digest(forked, camera)


@pytest.mark.skipif(not hasattr(os, "fork"), reason="this system has no fork")
@pytest.mark.filterwarnings("ignore:.*fork.*:DeprecationWarning")
def test_a_fork_amid_a_frame_is_an_exception_and_no_wait(scene, cameras):
    renderer = basrelief.Renderer(scene, threads=1)
    stop = threading.Event()

    def draw():
        while not stop.is_set():
            renderer.render(cameras * 4, (256, 192))

    thread = threading.Thread(target=draw)
    thread.start()
    time.sleep(0.2)
    child = os.fork()
    if child == 0:
        # 0: drawn, or refused with what to do; anything else is a failure.
        try:
            renderer.render(cameras[0], (16, 16))
            code = 0
        except RuntimeError as error:
            code = 0 if "make a renderer" in str(error) else 2
        except BaseException:
            code = 3
        os._exit(code)
    stop.set()
    deadline = time.monotonic() + 30
    while (ended := os.waitpid(child, os.WNOHANG)) == (0, 0) and time.monotonic() < deadline:
        time.sleep(0.05)
    if ended == (0, 0):
        os.kill(child, 9)
        os.waitpid(child, 0)
    thread.join()
    assert ended != (0, 0) and os.waitstatus_to_exitcode(ended[1]) == 0


def test_spawned_processes_draw_the_same(cameras):
    context = multiprocessing.get_context("spawn")
    with context.Pool(2) as pool:
        found = pool.map_async(of_its_own, cameras[:2]).get(timeout=120)
    assert found == [of_its_own(camera) for camera in cameras[:2]]


def test_the_interpreter_runs_while_frames_are_drawn(scene, cameras):
    renderer = basrelief.Renderer(scene, threads=1)
    ticks, done = [], threading.Event()

    def tick():
        while not done.is_set():
            ticks.append(time.perf_counter())
            time.sleep(0.001)

    thread = threading.Thread(target=tick)
    thread.start()
    renderer.render(cameras * 10, (256, 192))
    done.set()
    thread.join()
    assert len(ticks) > 5


def test_builds_can_be_asked_for():
    from basrelief import _builds

    if not any(name.startswith("_native_v") for name in os.listdir(os.path.dirname(_builds.__file__))):
        pytest.skip("one build only")
    code = "import basrelief; print(basrelief.SIMD_LEVEL)"
    levels = {
        level: subprocess.check_output(
            [sys.executable, "-c", code], env={**os.environ, "BASRELIEF_SIMD": level}
        )
        for level in _builds._levels()
    }
    assert len(set(levels.values())) == len(levels)
