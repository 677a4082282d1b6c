"""Pictures as tristimulus values, layer by layer."""

import numpy as np

from figures_lib.measure import XYZ_OF_RGB

LAYERS = {"whole": "", "fluorescence": "fluorescence", "single": "single", "multiple": "multiple", "surface": "surface"}
BLOCK = 8  # pixels


def xyz(picture):
    """Layer -> [height, width, 3] of X, Y, Z in cd/m^2."""
    return {name: picture.layers[layer] @ XYZ_OF_RGB.T for name, layer in LAYERS.items()}


def blocks(image, edge=BLOCK):
    """Means of an image [height, width, 3] over blocks of edge x edge pixels, [blocks, 3]; those at the right and the
    bottom may be smaller."""
    height, width, _ = image.shape
    rows, columns = np.arange(0, height, edge), np.arange(0, width, edge)
    sums = np.add.reduceat(np.add.reduceat(image, rows, axis=0), columns, axis=1)
    counts = np.outer(np.diff(np.append(rows, height)), np.diff(np.append(columns, width)))
    return (sums / counts[..., None]).reshape(-1, 3)


def mean_level(image):
    """What relative errors are relative to, as in `stokes compare`."""
    return float(np.mean(np.abs(image)))
