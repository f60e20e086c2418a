"""The filters alone, and what one pixel sees."""

import numpy as np
import pytest

import basrelief


@pytest.fixture(scope="module")
def ridges():
    """White ridges across u with black joints as deep as a tenth of a repeat."""
    ridge = (np.arange(64) % 16 < 8).astype(np.float32)
    height = np.tile(ridge, (64, 1))
    return basrelief.Surface(np.repeat(height[..., None], 3, axis=2), height, 0.1)


@pytest.mark.parametrize("name", ["horizon", "visible"])
def test_low_views_see_the_ridges(ridges, name):
    view = [[0, 0, 1], [0.9, 0, 0.3]]
    colors = ridges.colors([[0.3, 0.7]] * 2, [[0.5, 0]] * 2, [[0, 0.1]] * 2, view, filter=name)
    assert colors.shape == (2, 3) and colors.dtype == np.float32
    assert 0.4 < colors[0, 0] < 0.6 and colors[1, 0] > 0.8
    ewa = ridges.colors([[0.3, 0.7]] * 2, [[0.5, 0]] * 2, [[0, 0.1]] * 2, view, filter="ewa")
    assert 0.4 < ewa[1, 0] < 0.6


def test_each_pixel_is_by_itself(ridges):
    random = np.random.default_rng(1)
    shape = (40, 60)
    uv, dx, dy = (random.uniform(-s, s, (*shape, 2)) for s in (3, 0.1, 0.1))
    view = random.uniform(-1, 1, (*shape, 3)) + [0, 0, 1.5]
    whole = ridges.colors(uv, dx, dy, view, threads=1)
    assert whole.shape == (40, 60, 3)
    assert np.array_equal(whole, ridges.colors(uv, dx, dy, view, threads=3))
    at = (11, 17)
    assert np.array_equal(whole[at], ridges.colors(uv[at], dx[at], dy[at], view[at]))
    assert ridges.colors(np.empty((0, 2)), np.empty((0, 2)), np.empty((0, 2))).shape == (0, 3)


def test_inspect_gives_the_papers_numbers(scene):
    renderer = basrelief.Renderer(scene, filter=basrelief.Filter("visible", texel_budget=0))
    camera = basrelief.Camera((0, 1.2, 4), (0, 0, 2))
    seen = renderer.inspect((32, 40), camera, (64, 64))
    sets = seen["sets"]
    assert seen["object"] == 0 and seen["relief_depth"] == pytest.approx(0.1)
    assert len(sets["all"]) == len(sets["visible"]) + len(sets["hidden"]) > 0
    assert sets["all"].dtype == np.int32 and sets["covered_by"].shape == sets["covered"].shape
    ellipse = seen["readings"]["meant"]["flat"]["conic"]
    dx, dy = seen["readings"]["meant"]["flat"]["dx"], seen["readings"]["meant"]["flat"]["dy"]
    n = sets["texels_per_repeat"]
    assert ellipse["a"] == pytest.approx((dx[1] * n[1]) ** 2 + (dy[1] * n[1]) ** 2, rel=1e-4)
    base, moved, depth = (np.array(seen["ray"][k]) for k in ["base", "displacement", "hit_depth"])
    assert np.allclose(base + moved * depth, seen["ray"]["hit"], atol=1e-5)
    with pytest.raises(ValueError, match="pixel 0,0"):
        renderer.inspect((0, 0), basrelief.Camera((0, 1, 4), (0, 9, 4.1)), (64, 64))
