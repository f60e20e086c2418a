"""The paper's filter on derivatives of one's own: python filter_alone.py

A renderer of one's own, in NumPy, casts a ray a pixel onto a floor of stones, and knows the place
of each on the texture, its derivatives and the view. The filters do the rest. Prints how bright the
rows are by each: towards the horizon stones hide the joints between them.
"""

import basrelief
import numpy as np

WIDTH, HEIGHT = 96, 64


def stones(side=256, num=8):
    """Round stones with dark joints: heights and linear colours."""
    y, x = (np.mgrid[0:side, 0:side] + 0.5) * num / side
    height = np.clip(1.1 - 3.2 * ((x % 1 - 0.5) ** 2 + (y % 1 - 0.5) ** 2), 0, 1)
    return height.astype(np.float32), np.repeat(height[..., None], 3, axis=2).astype(np.float32)


def floor_seen(x, y):
    """Where the ray of a place in the picture meets the floor, a unit below the eye."""
    ray = np.stack([(x - WIDTH / 2) / HEIGHT, np.full_like(x, 1.0), (y + 2) / HEIGHT], axis=-1)
    return ray[..., :2] / ray[..., 2:], ray


def main():
    height, color = stones()
    surface = basrelief.Surface(color, height, relief_depth=0.06)
    y, x = np.mgrid[0:HEIGHT, 0:WIDTH] + 0.5
    place, view = floor_seen(x, y)
    dx, dy = floor_seen(x + 1, y)[0] - place, floor_seen(x, y + 1)[0] - place
    # The eye looks along v; down is into the relief.
    pictures = {
        name: surface.colors(place, dx, dy, view, filter=name) for name in ["visible", "horizon", "ewa"]
    }
    print("rows    " + "".join(f"{name:>10}" for name in pictures))
    for row in range(0, HEIGHT, 16):
        means = [picture[row : row + 16].mean() for picture in pictures.values()]
        print(f"{row:2} to {row + 15:2}" + "".join(f"{mean:10.3f}" for mean in means))


if __name__ == "__main__":
    main()
