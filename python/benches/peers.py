"""Small frames beside other renderers: python peers.py MODEL TEXTURE [FRAMES]

Color, depth and ids of the object, 256x256, one thread, cameras on a circle around a model: as many
as can be imported of pybullet (its TinyRenderer), mujoco and pyrender (both on OpenGL, such as EGL
with llvmpipe: MUJOCO_GL=egl PYOPENGL_PLATFORM=egl LP_NUM_THREADS=0). They leave out faces seen from
behind, and so does basrelief where it says so. All take turns; prints the fastest of five rounds of
each.
"""

import os
import sys
import tempfile
import time
from pathlib import Path

import basrelief
import numpy as np
from small_frames import LAYERS, SIZE, around

ROUNDS = 5


def ours(model, texture, cameras, **settings):
    scene = basrelief.load(model, albedo=texture)
    renderer = basrelief.Renderer(scene, filter="trilinear", msaa=1, threads=1, **settings)
    out = renderer.render(cameras, SIZE, LAYERS)
    return lambda: renderer.render(cameras, SIZE, LAYERS, out=out)["object"][0]


def pybullet(model, texture, cameras):
    import pybullet as p

    p.connect(p.DIRECT)
    shape = p.createVisualShape(p.GEOM_MESH, fileName=model)
    body = p.createMultiBody(baseVisualShapeIndex=shape)
    p.changeVisualShape(body, -1, textureUniqueId=p.loadTexture(texture))

    def frame(camera):
        view = p.computeViewMatrix(camera.eye, camera.target, camera.up)
        lens = p.computeProjectionMatrixFOV(camera.fov, 1, 0.01, 100)
        return p.getCameraImage(*SIZE, view, lens, renderer=p.ER_TINY_RENDERER, shadow=0)[4]

    return lambda: [np.reshape(frame(camera), SIZE) for camera in cameras][0]


def mujoco(model, texture, cameras):
    import mujoco

    with tempfile.NamedTemporaryFile(suffix=".obj") as plain:
        # Groups and materials of the file are not understood.
        kept = ("v ", "vt ", "vn ", "f ")
        lines = [line for line in Path(model).read_text().splitlines() if line.startswith(kept)]
        Path(plain.name).write_text("\n".join(lines))
        spec = f"""<mujoco><visual><map znear="0.001"/><global fovy="{cameras[0].fov}"/></visual><asset>
            <mesh name="m" file="{plain.name}" inertia="shell"/>
            <texture name="t" type="2d" file="{texture}"/><material name="t" texture="t"/></asset>
            <worldbody><geom type="mesh" mesh="m" material="t"/></worldbody></mujoco>"""
        world = mujoco.MjModel.from_xml_string(spec)
    data = mujoco.MjData(world)
    mujoco.mj_forward(world, data)
    renderer = mujoco.Renderer(world, *SIZE)
    renderer.scene.flags[mujoco.mjtRndFlag.mjRND_SHADOW] = 0
    center = data.geom_xpos[0]

    def frame(camera):
        eye, target = np.array(camera.eye), np.array(camera.target)
        back = eye - target
        free = mujoco.MjvCamera()
        free.lookat, free.distance = center, np.linalg.norm(back)
        free.azimuth = np.degrees(np.arctan2(-back[2], -back[0]))
        free.elevation = -np.degrees(np.arcsin(back[1] / free.distance))
        renderer.update_scene(data, free)
        renderer.render()
        renderer.enable_depth_rendering()
        renderer.render()
        renderer.disable_depth_rendering()
        renderer.enable_segmentation_rendering()
        ids = renderer.render()[..., 0]
        renderer.disable_segmentation_rendering()
        return ids

    return lambda: [frame(camera) for camera in cameras][0]


def pyrender(model, texture, cameras):
    import pyrender
    import trimesh
    from PIL import Image

    mesh = trimesh.load(model, process=False)
    mesh.visual = trimesh.visual.TextureVisuals(mesh.visual.uv, image=Image.open(texture))
    scene = pyrender.Scene(ambient_light=[0.3] * 3)
    body = scene.add(pyrender.Mesh.from_trimesh(mesh))
    scene.add(pyrender.DirectionalLight(intensity=3))
    eye = scene.add(pyrender.PerspectiveCamera(np.radians(cameras[0].fov)))
    renderer = pyrender.OffscreenRenderer(*SIZE)

    def frame(camera):
        back = np.array(camera.eye) - np.array(camera.target)
        back /= np.linalg.norm(back)
        right = np.cross(camera.up, back)
        right /= np.linalg.norm(right)
        pose = np.eye(4)
        pose[:3] = np.stack([right, np.cross(back, right), back, camera.eye], axis=1)
        scene.set_pose(eye, pose)
        renderer.render(scene)
        ids, _ = renderer.render(scene, pyrender.RenderFlags.SEG, {body: (0, 0, 1)})
        return ids[..., 2]

    return lambda: [frame(camera) for camera in cameras][0]


def main(model, texture, num="200"):
    scene = basrelief.load(model, albedo=texture)
    cameras = list(around(scene.camera, int(num)))
    draws = {}
    for lighting in ["unlit", "lit"]:
        for cull, word in [(False, "all faces"), (True, "front faces")]:
            draw = ours(model, texture, cameras, lighting=lighting, cull=cull)
            draws[f"basrelief, {lighting}, {word}"] = draw
    for peer in [pybullet, mujoco, pyrender]:
        try:
            draws[peer.__name__] = peer(os.path.abspath(model), os.path.abspath(texture), cameras)
        except Exception as error:
            print(f"{peer.__name__} is left out: {error!r}"[:200])
    times = {name: [] for name in draws}
    for _ in range(ROUNDS):
        for name, draw in draws.items():
            start = time.perf_counter()
            ids = draw()
            times[name].append((time.perf_counter() - start) * 1000 / len(cameras))
            if len(times[name]) == 1:
                print(f"{name}: sees {np.mean(ids != ids[0, 0]):.1%} of the first frame")
    for name, took in times.items():
        print(f"{name}: {min(took):.3f} ms a frame")


if __name__ == "__main__":
    main(*sys.argv[1:])
