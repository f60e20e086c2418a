"""Frames are the same however they are asked for."""

import pickle
import threading

import numpy as np
import pytest
from conftest import LAYERS, same

import basrelief


def test_layers_have_their_shapes_and_types(scene):
    frame = basrelief.Renderer(scene).render(size=(50, 30), layers=basrelief.LAYERS)
    assert list(frame) == basrelief.LAYERS
    for name, array in frame.items():
        assert array.shape[:2] == (30, 50) and array.flags.c_contiguous
        channels = {"depth": 1, "uv": 2, "color": 4, "linear": 4}
        is_id = name in ("object", "material", "triangle")
        num = 1 if is_id else channels.get(name.removeprefix("polygon-"), 3)
        assert array.shape[2:] == (() if num == 1 else (num,)), name
        assert array.dtype == (np.uint32 if is_id else np.uint8 if name == "color" else np.float32)


def test_layers_say_one_thing(scene):
    frame = basrelief.Renderer(scene).render(size=(80, 60), layers=basrelief.LAYERS)
    seen = frame["object"] != basrelief.NOTHING
    assert 0.2 < seen.mean() < 1 and set(np.unique(frame["object"][seen])) == {0, 1}
    assert scene.objects == ["floor", "body"] and scene.materials == ["stones", "red"]
    assert np.array_equal(np.isfinite(frame["depth"]), seen)
    assert np.allclose(np.linalg.norm(frame["normal"][seen], axis=-1), 1, atol=1e-5)
    assert np.allclose(frame["camera-position"][seen][:, 2], frame["depth"][seen])
    # The eye and the depth along the view give the place.
    away = frame["position"][seen] - np.float32(scene.camera.eye)
    forward = np.subtract(scene.camera.target, scene.camera.eye)
    assert np.allclose(away @ (forward / np.linalg.norm(forward)), frame["depth"][seen], rtol=1e-5)


def test_threads_and_tiles_give_the_same_bytes(scene):
    frames = [
        basrelief.Renderer(scene, threads=threads, tile_size=tile).render(size=(97, 61), layers=LAYERS)
        for threads, tile in [(1, 32), (2, 16), (5, 128)]
    ]
    assert same(frames[0], frames[1]) and same(frames[0], frames[2])


def test_a_batch_is_its_frames(scene, cameras):
    renderer = basrelief.Renderer(scene)
    batch = renderer.render(cameras, (48, 32), LAYERS)
    assert batch["color"].shape == (5, 32, 48, 4) and batch["depth"].shape == (5, 32, 48)
    for i, camera in enumerate(cameras):
        single = renderer.render(camera, (48, 32), LAYERS)
        assert same(single, {name: array[i] for name, array in batch.items()})
    kept = list(renderer.frames(iter(cameras), (48, 32), LAYERS))
    assert all(same(kept[i], renderer.render(c, (48, 32), LAYERS)) for i, c in enumerate(cameras))
    assert renderer.render([], (48, 32), LAYERS)["normal"].shape == (0, 32, 48, 3)


def test_frames_can_reuse_their_arrays(scene, cameras):
    renderer = basrelief.Renderer(scene)
    wanted = renderer.render(cameras, (48, 32), LAYERS)
    addresses = set()
    for i, frame in enumerate(renderer.frames(cameras, (48, 32), LAYERS, reuse=True)):
        assert same(frame, {name: array[i] for name, array in wanted.items()})
        addresses.add(frame["color"].ctypes.data)
    assert len(addresses) == 1


def test_arrays_of_the_callers_are_written_to(scene, cameras):
    renderer = basrelief.Renderer(scene)
    wanted = renderer.render(cameras, (48, 32), ["color", "depth"])
    room = np.full((7, 32, 48, 4), 9, dtype=np.uint8)
    out = {"color": room[1:6], "depth": np.empty((5, 32, 48), dtype=np.float32)}
    found = renderer.render(cameras, (48, 32), ["color", "depth"], out=out)
    assert found["color"] is out["color"] and same(found, wanted)
    assert (room[0] == 9).all() and (room[6] == 9).all()


def test_a_region_is_a_part_of_the_frame(scene):
    renderer = basrelief.Renderer(scene)
    whole = renderer.render(size=(96, 64), layers=LAYERS)
    part = renderer.render(size=(96, 64), layers=LAYERS, region=(11, 7, 40, 30))
    assert same(part, {name: array[7:37, 11:51] for name, array in whole.items()})


def test_placed_meshes_are_drawn_where_they_are(make_scene):
    moved = (0.25, 0.5, -0.75)
    matrix = np.eye(4)
    matrix[:3, 3] = moved
    for lighting in ["lit", "unlit"]:
        renderer = basrelief.Renderer(make_scene(), lighting=lighting)
        before = renderer.render(size=(64, 48), layers=LAYERS)
        renderer.place({"body": matrix})
        wanted = basrelief.Renderer(make_scene(moved), lighting=lighting).render(size=(64, 48), layers=LAYERS)
        assert same(renderer.render(size=(64, 48), layers=LAYERS), wanted) and not same(before, wanted)
        renderer.place({1: np.eye(4)})
        assert same(renderer.render(size=(64, 48), layers=LAYERS), before)


def test_turned_meshes_have_turned_normals(make_scene):
    renderer = basrelief.Renderer(make_scene())
    turn = np.array([[0, 0, 2, 0], [0, 2, 0, 0], [-2, 0, 0, 0], [0, 0, 0, 1]])
    renderer.place({"body": turn})
    frame = renderer.render(size=(64, 48), layers=["normal", "object"])
    normals = frame["normal"][frame["object"] == 1]
    assert len(normals) and np.allclose(np.linalg.norm(normals, axis=-1), 1, atol=1e-5)


def test_vertices_can_be_replaced(make_scene):
    renderer = basrelief.Renderer(make_scene())
    points = np.array([[0, 1.5, 0], [-1, 0.5, 1], [1, 0.5, 1], [0, 0.5, -1]], dtype=np.float32)
    renderer.set_vertices("body", points + np.float32([0.5, 0, 0]))
    wanted = basrelief.Renderer(make_scene((0.5, 0, 0))).render(size=(64, 48), layers=LAYERS)
    assert same(renderer.render(size=(64, 48), layers=LAYERS), wanted)


def test_threads_share_a_renderer(scene, cameras):
    renderer = basrelief.Renderer(scene, threads=2)
    wanted = renderer.render(cameras, (48, 32), LAYERS)
    found = [None] * len(cameras)

    def draw(i):
        found[i] = renderer.render(cameras[i], (48, 32), LAYERS)

    threads = [threading.Thread(target=draw, args=(i,)) for i in range(len(cameras))]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert all(same(found[i], {n: a[i] for n, a in wanted.items()}) for i in range(len(cameras)))


def test_intrinsics_of_opencv_and_opengl_see_the_same(scene):
    renderer = basrelief.Renderer(scene)
    pose = np.array([[1, 0, 0, 0], [0, -1, 0, 1], [0, 0, -1, 5], [0, 0, 0, 1]], dtype=float)
    opencv = basrelief.Camera.from_intrinsics(60, 60, 31.5, 23.5, pose, first_pixel=0)
    opengl = basrelief.Camera.from_intrinsics(60, 60, 32, 24, pose @ np.diag([1, -1, -1, 1]), "opengl")
    assert opencv == opengl and opencv.intrinsics == (60, 60, 32, 24)
    plain = basrelief.Camera((0, 1, 5), (0, 1, 0), fov=2 * np.degrees(np.arctan(24 / 60)))
    frames = [renderer.render(camera, (64, 48), ["object", "depth"]) for camera in [opencv, opengl, plain]]
    assert same(frames[0], frames[1])
    assert (frames[0]["object"] == frames[2]["object"]).mean() > 0.999


def test_orthographic_cameras_see_a_plan(scene):
    # Straight down on a floor at 0 and a tetrahedron over it, whose apex is at (0, 1.5, 0).
    plan = basrelief.Camera((0, 9, 0), (0, 0, 0), up=(0, 0, -1), orthographic=6)
    renderer = basrelief.Renderer(scene)
    frame = renderer.render(plan, (66, 66), ["object", "position", "polygon-depth"])
    body = frame["object"] == 1
    # Its base from (-1, 1) to (1, 1) and (0, -1) is of area 2, whatever its height.
    assert abs(body.sum() * (6 / 66) ** 2 - 2) < 0.1
    assert np.allclose(frame["polygon-depth"][~body], 9) and (frame["polygon-depth"][body] < 8.6).all()
    places = (np.arange(66) + 0.5) / 11 - 3
    assert np.allclose(frame["position"][..., 0], places, atol=1e-5)
    assert np.allclose(frame["position"][..., 2], places[:, None], atol=1e-5)
    # Nearer or farther, it is as large.
    lifted = renderer.render(plan.replace(eye=(0, 20, 0)), (66, 66), "object")
    assert np.array_equal(lifted["object"], frame["object"])


def test_lenses_take_each_others_place():
    plan = basrelief.Camera((0, 9, 0), (0, 0, 0), up=(0, 0, -1), orthographic=6)
    assert plan.orthographic == 6 and plan.replace(near=2).orthographic == 6
    assert plan.replace(orthographic=2).orthographic == 2
    assert plan.replace(fov=30) == basrelief.Camera((0, 9, 0), (0, 0, 0), up=(0, 0, -1), fov=30)
    posed = basrelief.Camera.from_intrinsics(60, 50, 32, 24, np.eye(4), near=0.5)
    assert posed.replace(near=0.25).intrinsics == (60, 50, 32, 24) and posed.orthographic is None
    assert posed.replace(fov=30).intrinsics is None
    parallel = posed.replace(orthographic=3)
    assert (parallel.intrinsics, parallel.orthographic) == (None, 3)
    assert "orthographic=3" in repr(parallel) and "fov=60" in repr(parallel.replace(fov=60))


def test_cameras_can_be_pickled(cameras):
    posed = basrelief.Camera.from_intrinsics(60, 50, 32, 24, np.eye(4), near=0.5)
    for camera in [*cameras, posed, posed.replace(orthographic=0.3)]:
        assert pickle.loads(pickle.dumps(camera)) == camera


@pytest.mark.parametrize("name", basrelief.FILTERS)
def test_every_filter_draws(scene, name):
    options = {"samples": 4} if name in ("truth", "parallax") else {}
    renderer = basrelief.Renderer(scene, filter=basrelief.Filter(name, **options), lighting="unlit")
    assert renderer.render(size=(32, 24))["color"][..., 3].any()
