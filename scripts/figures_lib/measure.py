"""Measurements on pictures and curves."""

import numpy as np

XYZ_OF_RGB = np.array(
    [[0.4123908, 0.3575843, 0.1804808], [0.2126390, 0.7151687, 0.0721923], [0.0193308, 0.1191948, 0.9505322]]
)  # linear Rec. 709 to CIE 1931


def chromaticity(rgb):
    """CIE 1931 (x, y) of a mean colour [3] of linear Rec. 709."""
    xyz = XYZ_OF_RGB @ np.asarray(rgb)
    return (xyz[:2] / xyz.sum()).tolist()


def rmse(a, b):
    """Root mean square over pixels and over X, Y, Z of the difference of two pictures in Rec. 709, cd/m^2."""
    return float(np.sqrt(np.mean(((a - b) @ XYZ_OF_RGB.T) ** 2)))


def binned(distance, value, edges):
    """Means of value over the bins of distance; nan where a bin has no pixel."""
    inside = np.isfinite(distance) & np.isfinite(value)
    counts, _ = np.histogram(distance[inside], edges)
    sums, _ = np.histogram(distance[inside], edges, weights=value[inside])
    with np.errstate(invalid="ignore"):
        return np.where(counts > 0, sums / np.maximum(counts, 1), np.nan)


def edge_width(centres, profile, plateau):
    """10-90 % width [mm] of a rise from dark (negative distance) to bright. The levels are the means beyond `plateau`
    mm on either side; the crossings are those next to the middle of the rise, between bins on straight lines."""
    filled = np.isfinite(profile)
    x, y = np.asarray(centres)[filled], np.asarray(profile)[filled]
    dark, bright = y[x < -plateau], y[x > plateau]
    if len(dark) == 0 or len(bright) == 0 or bright.mean() <= dark.mean():
        return float("nan")
    level = (y - dark.mean()) / (bright.mean() - dark.mean())
    middle = int(np.argmin(np.abs(level - 0.5) + np.where(np.abs(x) > plateau, 10, 0)))
    low, high = middle, middle
    while low > 0 and level[low] > 0.1:
        low -= 1
    while high < len(level) - 1 and level[high] < 0.9:
        high += 1
    return float(_crossing(x, level, high - 1, 0.9) - _crossing(x, level, low, 0.1))


def _crossing(x, level, left, value):
    left = max(left, 0)
    rise = level[left + 1] - level[left]
    share = (value - level[left]) / rise if rise != 0 else 0.5
    return x[left] + min(max(share, 0), 1) * (x[left + 1] - x[left])


def edge(distance, along, value, reach, step, plateau, pieces=8):
    """Profile of value across an edge. distance, along [mm]: of each pixel from the edge, positive on the bright side,
    and along it. Returns bin centres, the profile, its 10-90 % width and that width's standard error from `pieces`
    parts of the edge."""
    edges = np.arange(-reach, reach + step / 2, step)
    centres = (edges[1:] + edges[:-1]) / 2
    inside = np.isfinite(distance) & (np.abs(distance) <= reach) & np.isfinite(along) & np.isfinite(value)
    distance, along, value = distance[inside], along[inside], value[inside]
    profile = binned(distance, value, edges)
    limits = np.quantile(along, np.linspace(0, 1, pieces + 1)) if len(along) else np.zeros(pieces + 1)
    widths = []
    for first, last in zip(limits, limits[1:]):
        part = (along >= first) & (along <= last)
        widths.append(edge_width(centres, binned(distance[part], value[part], edges), plateau))
    widths = np.array(widths)[np.isfinite(widths)]
    error = float(np.std(widths, ddof=1) / np.sqrt(len(widths))) if len(widths) > 1 else float("nan")
    return centres, profile, edge_width(centres, profile, plateau), error


def slope(passes, errors):
    """Slope of log error over log passes by least squares, and its standard error."""
    x, y = np.log(passes), np.log(errors)
    a, b = np.polyfit(x, y, 1)
    residuals = y - (a * x + b)
    spread = np.sum((x - x.mean()) ** 2)
    error = np.sqrt(np.sum(residuals**2) / (len(x) - 2) / spread) if len(x) > 2 else float("nan")
    return float(a), float(error)


def true_error(passes, errors, truth_passes):
    """Errors against the limit, from errors against a picture of truth_passes passes and another seed. Both pictures
    err, independently: errors^2 = a^2 (passes^2s + truth_passes^2s). a and s are fitted to that in logarithms; the
    truth's part is taken off. Returns the errors and that of the truth."""
    passes, errors = np.asarray(passes, float), np.asarray(errors, float)
    best = None
    for s in np.linspace(-1.0, -0.05, 191):
        shape = 0.5 * np.log(passes ** (2 * s) + float(truth_passes) ** (2 * s))
        offset = np.mean(np.log(errors) - shape)
        miss = np.sum((np.log(errors) - shape - offset) ** 2)
        if best is None or miss < best[0]:
            best = miss, s, np.exp(offset)
    _, s, a = best
    truth = a * truth_passes**s
    return np.sqrt(np.maximum(errors**2 - truth**2, 1e-30)), float(truth)


def pass_ratio(passes, errors_a, errors_b):
    """How many times the passes of curve b curve a needs for the same error, and its standard error. Both curves have
    the same passes and, seed by seed, the same wavelengths, so their gap in logarithms is far better known than either
    of them; divided by their common slope it is the ratio."""
    x = np.log(np.asarray(passes, float))
    curves = [np.log(np.asarray(errors)) for errors in (errors_a, errors_b)]
    gaps = curves[0] - curves[1]
    both = np.concatenate([curve - curve.mean() for curve in curves])
    centred = np.tile(x - x.mean(), 2)
    common = np.sum(both * centred) / np.sum(centred**2)
    if common >= 0:
        return float("nan"), float("nan")
    miss = both - common * centred
    common_error = np.sqrt(np.sum(miss**2) / (len(both) - 3) / np.sum(centred**2)) if len(x) > 2 else float("nan")
    gap, gap_error = gaps.mean(), gaps.std(ddof=1) / np.sqrt(len(gaps))
    ratio = np.exp(-gap / common)
    return float(ratio), float(ratio * np.hypot(gap_error / common, gap * common_error / common**2))


def rmse_of_shape(picture, truth):
    """rmse after each of X, Y, Z of the picture was scaled to fit the truth best: what the draw of wavelengths does to
    the brightness and hue of the whole picture does not count, the grain does."""
    xyz, wanted = (image.reshape(-1, 3) @ XYZ_OF_RGB.T for image in (picture, truth))
    gain = np.sum(xyz * wanted, axis=0) / np.maximum(np.sum(xyz**2, axis=0), 1e-300)
    return float(np.sqrt(np.mean((gain * xyz - wanted) ** 2)))
