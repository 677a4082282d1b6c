"""Figures 16 and 17: a disk of six sectors of rising c, a sphere's shadow on it, and two scattering coefficients."""

import numpy as np

from figures_lib import camera, figure, measure, page, scenes
from figures_lib.figure import MODELS, base, exposure_of, job

KEYS = ("fig16", "fig17")

SCALES = {"x1": 0.5, "x2": 1.0}  # of the marble's scattering; the paper's scenes halve it
CLOSE_UP = {"left": 0.38, "top": 0.405, "width": 0.345, "height": 0.345}
TOP = 10  # [mm], the disk's face
RING = (24, 33)  # [mm] from the axis: beyond the shadow
HALF_SECTOR = 20  # [degrees] from a sector's middle that are looked at
REACH, PLATEAU, STEP = 7, 5.5, 0.2  # [mm], of the profile across the shadow's edge
FRACTIONS = [0.0, 0.2, 0.4, 0.6, 0.8, 1.0]


def jobs(settings):
    found = []
    for model in MODELS:
        for scale, factor in SCALES.items():
            whole = scenes.change(base("sectors", settings), {"media.marble.scale_sigma_s": factor})
            close = scenes.change(whole, {"camera.crop": CLOSE_UP})
            first = scale == "x1"
            found.append(
                job(
                    settings,
                    f"fig16_{scale}_{model}",
                    whole,
                    transport=model,
                    exposure=None if first else exposure_of(f"fig16_x1_{model}"),
                )
            )
            found.append(
                job(
                    settings,
                    f"fig17_{scale}_{model}",
                    close,
                    transport=model,
                    exposure=None if first else exposure_of(f"fig17_x1_{model}"),
                )
            )
    return found


def clockwise(x, z):
    """Degrees clockwise from the bottom (+z) of the picture, seen from above."""
    return np.degrees(np.arctan2(-x, z))


def on_disk(result):
    """x, z [mm] on the disk's face, and the degrees clockwise from the picture's bottom, of each pixel."""
    picture = result.picture()
    x, z = camera.on_plane(result.scene, picture.width, picture.height, TOP)
    return picture, x, z, clockwise(x, z)


def sector(angle, k):
    """Which pixels are in the middle of the sector with c = 0.2 k."""
    return np.abs((angle - 60 * k + 180) % 360 - 180) < HALF_SECTOR


def outside_shadow(scene, x, z):
    """Distance [mm] on the disk's face from the edge of the sphere's shadow, positive in the light; to first order."""
    light = np.array(scene["lights"][0]["direction"], float)
    light /= np.linalg.norm(light)
    sphere = next(shape for shape in scene["shapes"] if shape["name"] == "sphere")
    centre = np.array(sphere["transform"][0]["translate_mm"], float)
    to_point = np.stack([x - centre[0], np.full(x.shape, TOP - centre[1]), z - centre[2]], axis=-1)
    across = to_point - (to_point @ light)[..., None] * light
    from_axis = np.linalg.norm(across, axis=-1)
    steepness = np.hypot(across[..., 0], across[..., 2]) / from_axis
    return (from_axis - sphere["radius_mm"]) / steepness


def fluorescence(result):
    """Mean luminance [cd/m^2] of each sector in the light: of the fluorescence and in all."""
    picture, x, z, angle = on_disk(result)
    ring = (np.hypot(x, z) > RING[0]) & (np.hypot(x, z) < RING[1])

    def means(layer):
        light = picture.luminance(layer)
        rings = [light[ring & sector(angle, k)] for k in range(len(FRACTIONS))]
        return [float(part.mean()) if part.size else float("nan") for part in rings]

    return means("fluorescence"), means("")


def shadow_edge(result, sectors, layer=""):
    """Profile across the shadow's edge in some sectors, each relative to its light part; see measure.edge."""
    picture, x, z, angle = on_disk(result)
    distance = outside_shadow(result.scene, x, z)
    light = picture.luminance(layer)
    chosen, level = np.zeros(x.shape, bool), np.ones(x.shape)
    for k in sectors:
        inside = sector(angle, k) & (np.abs(distance) <= REACH) & (np.hypot(x, z) < 36)
        chosen |= inside
        bright = light[inside & (distance > PLATEAU)]
        level[inside] = bright.mean() if bright.size else np.nan
    return measure.edge(
        distance[chosen], angle[chosen], (light / level)[chosen], REACH, STEP * max(1, 320 / picture.width), PLATEAU
    )


def report(run):
    return [fractions(run), shadow(run)]


def fractions(run):
    drawing, axis = figure.axes()
    numbers = {"c": FRACTIONS}
    for model, style in (("paper", "o-"), ("conserving", "s:")):
        for scale, colour in (("x1", "#2a9d4b"), ("x2", "#2a6fbb")):
            light, whole = fluorescence(run.results[f"fig16_{scale}_{model}"])
            axis.plot(
                FRACTIONS,
                np.array(light) / light[-1],
                style,
                color=colour,
                markersize=4,
                label=f"{model}, scattering {scale}",
            )
            straight = np.array(light) / light[-1] - np.array(FRACTIONS)
            numbers.setdefault(model, {})[scale] = {
                "fluorescence_cd_m2": light,
                "luminance_cd_m2": whole,
                "rises": bool(np.all(np.diff(light) > 0)),
                "largest_departure_from_proportion": float(np.abs(straight).max()),
            }
    axis.plot([0, 1], [0, 1], color="grey", linewidth=0.7)
    axis.set_xlabel("fluorescent fraction c")
    axis.set_ylabel("fluorescence / that for c = 1")
    axis.legend(fontsize=8)
    own = numbers["paper"]["x1"]
    rises = all(numbers[model][scale]["rises"] for model in MODELS for scale in SCALES)
    rows = [
        [run.picture(f"fig16_{scale}_{model}", f"{model}, scattering {scale}") for scale in SCALES]
        for model in MODELS
    ]
    return page.Section(
        "fig16",
        "Figure 16: fluorescent fraction",
        "A disk of six sectors, c = 0, 0.2 .. 1.0 clockwise from the bottom, with a sphere's shadow on it:"
        " fluorescence rises with c.",
        "Luminance of the fluorescence for c = 0 .. 1: "
        + ", ".join(f"{v:.3g}" for v in own["fluorescence_cd_m2"])
        + f" cd/m². It departs from proportion to c by at most {100 * own['largest_departure_from_proportion']:.1f} %"
        " of its maximum.",
        ("Same: it rises from sector to sector." if rises else "At these settings it does not rise everywhere.")
        + " It is proportional to c, as STEP 1 makes c the chance of meeting a fluorophore; what is left for c = 0"
        " came from the neighbours.",
        [*rows, [run.plot("fig16", drawing, "Mean over the part of each sector beyond the shadow.", wide=False)]],
        numbers,
    )


def shadow(run):
    drawing, axes = figure.axes(2)
    numbers = {}
    bright = range(2, 6)
    for axis, model in zip(axes, MODELS):
        for scale, colour in (("x1", "#2a9d4b"), ("x2", "#2a6fbb")):
            result = run.results[f"fig17_{scale}_{model}"]
            centres, profile, width, error = shadow_edge(result, bright)
            axis.plot(centres, profile, color=colour, label=f"scattering {scale}: {width:.2f} ± {error:.2f} mm")
            sectors = [shadow_edge(result, [k])[2] for k in bright]
            numbers.setdefault(model, {})[scale] = {
                "edge_width_mm": width,
                "standard_error_mm": error,
                "edge_width_mm_by_sector": sectors,
                "sectors_c": FRACTIONS[2:],
            }
        axis.set_title(f"model {model}: 10-90 % widths, c = 0.4 to 1")
        axis.set_xlabel("distance from the shadow's edge, light positive [mm]")
        axis.legend()
    axes[0].set_ylabel("luminance / that in the light")
    a, b = numbers["paper"]["x1"], numbers["paper"]["x2"]
    numbers = {
        "edge_width_mm": {"x1": a["edge_width_mm"], "x2": b["edge_width_mm"]},
        "width_ratio": a["edge_width_mm"] / b["edge_width_mm"],
        **numbers,
    }
    wider = a["edge_width_mm"] > b["edge_width_mm"]
    rows = [
        [run.picture(f"fig17_{scale}_{model}", f"Close-up, {model}, scattering {scale}") for scale in SCALES]
        for model in MODELS
    ]
    return page.Section(
        "fig17",
        "Figure 17: the shadow's edge, close",
        "Close-ups for two scattering coefficients: the shadow's edge is wider for the smaller.",
        f"10-90 % widths over the sectors with c = 0.4 to 1: {a['edge_width_mm']:.2f} ± {a['standard_error_mm']:.2f}"
        f" mm with the smaller and {b['edge_width_mm']:.2f} ± {b['standard_error_mm']:.2f} mm with the larger"
        f" coefficient, ratio {numbers['width_ratio']:.2f}. Model conserving:"
        f" {numbers['conserving']['x1']['edge_width_mm']:.2f} and"
        f" {numbers['conserving']['x2']['edge_width_mm']:.2f} mm.",
        (
            "Same: wider for the smaller coefficient."
            if wider
            else "At these settings the difference is within the noise."
        )
        + " The smaller one is the marble of all scenes, the larger the unhalved. The distances in the tables are"
        " about as long as the mean free path; the density estimate's radius,"
        f" {figure.radius_note(run.results['fig17_x1_paper'])} in the last pass, adds to both widths.",
        [*rows, [run.plot("fig17", drawing, "Across the shadow's edge, distances on the disk's face.")]],
        numbers,
    )
