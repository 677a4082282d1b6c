"""Where the pixels of a scene's camera look: to measure pictures in millimetres."""

import numpy as np


def _unit(v):
    return v / np.linalg.norm(v)


def rays(scene, width, height):
    """The pinhole [3] and unit directions [height, width, 3] through the middle of each pixel."""
    camera = scene["camera"]
    position = np.array(camera["position_mm"], float)
    forward = _unit(np.array(camera["target_mm"], float) - position)
    right = _unit(np.cross(forward, np.array(camera.get("up", [0, 1, 0]), float)))
    up = np.cross(right, forward)
    crop = camera.get("crop", {"left": 0, "top": 0, "width": 1, "height": 1})
    half_height = np.tan(np.radians(camera.get("vertical_fov_deg", 40)) / 2)
    # Pixels are square, so the whole picture's aspect follows from the window's.
    half_width = half_height * (width / crop["width"]) / (height / crop["height"])
    x = (2 * (crop["left"] + crop["width"] * (np.arange(width) + 0.5) / width) - 1) * half_width
    y = (1 - 2 * (crop["top"] + crop["height"] * (np.arange(height) + 0.5) / height)) * half_height
    directions = forward + x[None, :, None] * right + y[:, None, None] * up
    return position, directions / np.linalg.norm(directions, axis=-1, keepdims=True)


def on_plane(scene, width, height, y_mm):
    """x and z [mm], each [height, width], of what pixels see of the plane at height y_mm; nan above the horizon."""
    position, directions = rays(scene, width, height)
    with np.errstate(divide="ignore", invalid="ignore"):
        t = (y_mm - position[1]) / directions[..., 1]
    t = np.where(t > 0, t, np.nan)
    return position[0] + t * directions[..., 0], position[2] + t * directions[..., 2]


def on_sphere(scene, width, height, centre, radius):
    """Outward normals [height, width, 3] where pixels see the sphere, nan elsewhere."""
    position, directions = rays(scene, width, height)
    to_centre = np.array(centre, float) - position
    along = directions @ to_centre
    under_root = along**2 - to_centre @ to_centre + radius**2
    t = along - np.sqrt(np.where(under_root > 0, under_root, np.nan))
    return (position + t[..., None] * directions - np.array(centre)) / radius
