"""Figures 11 to 13: black light through masks onto a fluorescent sheet, with and without subsurface scattering."""

import numpy as np

from figures_lib import camera, figure, measure, page, scenes
from figures_lib.figure import GREEN, MODELS, RED, base, exposure_of, job

KEYS = ("fig11", "fig12", "fig13")

DOTS = {"545": GREEN, "655": RED}
MASKS = {"cat": "fig12", "star": "fig13"}
OPEN = {"x": (10, 18), "z": (-8, 0)}  # [mm], a part of the cat's window at least 3 mm from its edges
EDGE_X, EDGE_Z = 21, (-17, 3)  # [mm], the straight right edge of that window
REACH, PLATEAU, STEP = 8, 6, 0.2  # [mm], of the profile across it
SPOKES, STAR_RADIUS = 24, (3.5, 19.5)  # of the star; the radii [mm] where its contrast is read
LIGHT = "lights.black light.irradiance_W_m2"


def scene(settings, mask, dot, scattering):
    """scenes/masks.json with another mask or quantum dot; without scattering: c = 1 on the surface."""
    changes = {
        "shapes.mask.file": str(scenes.SCENES / f"textures/{mask}.png"),
        "materials.sheet.fluorophore": f"qdot{dot}",
    }
    if dot == "655":
        changes["fluorophores.qdot545"] = None
    else:
        changes["fluorophores.qdot655"] = None
    if not scattering:
        changes.update(
            {
                "materials.sheet.subsurface": False,
                "materials.sheet.fluorescent_fraction": 1,
                "materials.sheet.medium": None,
            }
        )
    return scenes.change(base("masks", settings), changes)


def open_luminance(result):
    """Mean luminance [cd/m^2] of the open part."""
    picture = result.picture()
    x, z = camera.on_plane(result.scene, picture.width, picture.height, 0)
    inside = (x > OPEN["x"][0]) & (x < OPEN["x"][1]) & (z > OPEN["z"][0]) & (z < OPEN["z"][1])
    return float(picture.luminance()[inside].mean())


def light_ratio(results, dot):
    """How much stronger the light must be without scattering, for the same brightness in the open."""
    return open_luminance(results[f"masks_probe_{dot}_with"]) / open_luminance(results[f"masks_probe_{dot}_without"])


def probes(settings):
    """Short renders from which the light is adjusted."""
    return [
        job(
            settings,
            f"masks_probe_{dot}_{word}",
            scene(settings, "cat", dot, scattering),
            size=settings.square,
            passes=settings.probe_passes,
        )
        for dot in DOTS
        for word, scattering in (("with", True), ("without", False))
    ]


def adjusted(settings, mask, dot):
    """The scene without scattering, its light adjusted."""
    plain = scene(settings, mask, dot, False)
    light = plain["lights"][0]["irradiance_W_m2"]
    return lambda results: scenes.change(plain, {LIGHT: light * light_ratio(results, dot)})


def jobs(settings):
    # Parallel light throws the same shadow from any height: here the mask hangs lower, to be in the picture.
    overview = {
        "camera.position_mm": [70, 112, 118],
        "camera.target_mm": [-2, 24, 0],
        "camera.up": [0, 1, 0],
        "camera.vertical_fov_deg": 34,
        "materials.card.reflectance": 0.9,
        "shapes.mask.transform.0.translate_mm": [0, 50, 0],
    }
    found = probes(settings)
    found.append(job(settings, "fig11", scenes.change(scene(settings, "cat", "545", True), overview)))
    for mask, key in MASKS.items():
        for dot in DOTS:
            for model in MODELS:
                found.append(
                    job(
                        settings,
                        f"{key}_{dot}_{model}",
                        scene(settings, mask, dot, True),
                        size=settings.square,
                        transport=model,
                    )
                )
            found.append(
                job(
                    settings,
                    f"{key}_{dot}_without",
                    adjusted(settings, mask, dot),
                    size=settings.square,
                    exposure=exposure_of(f"{key}_{dot}_paper"),
                )
            )
    return found


def window_edge(result, layer=""):
    """Profile across the window's right edge, see measure.edge."""
    picture = result.picture()
    x, z = camera.on_plane(result.scene, picture.width, picture.height, 0)
    inside = (z > EDGE_Z[0]) & (z < EDGE_Z[1])
    pixel = abs(x[0, 1] - x[0, 0])
    return measure.edge(
        EDGE_X - x[inside], z[inside], picture.luminance(layer)[inside], REACH, max(STEP, pixel), PLATEAU
    )


def star_contrast(result, bins=12):
    """Periods [mm] at some radii, and the contrast there: the share that is left of the mask's fundamental."""
    picture = result.picture()
    x, z = camera.on_plane(result.scene, picture.width, picture.height, 0)
    radius, angle, light = np.hypot(x, z), np.arctan2(z, x), picture.luminance()
    edges = np.geomspace(*STAR_RADIUS, bins + 1)
    periods, contrasts = [], []
    for low, high in zip(edges, edges[1:]):
        ring = (radius >= low) & (radius < high)
        # Least squares rather than a sum: pixels do not fill a ring evenly.
        waves = np.stack([np.ones(ring.sum()), np.cos(SPOKES * angle[ring]), np.sin(SPOKES * angle[ring])], axis=1)
        fit = np.linalg.lstsq(waves, light[ring], rcond=None)[0]
        periods.append(2 * np.pi * np.sqrt(low * high) / SPOKES)
        contrasts.append(float(np.hypot(fit[1], fit[2]) / fit[0] / (4 / np.pi)) if fit[0] > 0 else float("nan"))
    return np.array(periods), np.array(contrasts)


def half_contrast(periods, contrasts):
    """The period [mm] with half the contrast; nan where the curve does not cross it."""
    above = contrasts >= 0.5
    if above.all() or not above.any():
        return float("nan")
    k = int(np.argmax(above))
    return float(np.interp(0.5, contrasts[k - 1 : k + 1], periods[k - 1 : k + 1])) if k > 0 else float("nan")


def report(run):
    return [setup(run), silhouette(run), star(run)]


def setup(run):
    ratio = {f"qdot{dot}": light_ratio(run.results, dot) for dot in DOTS}
    return page.Section(
        "fig11",
        "Figure 11: light through a mask",
        "Parallel black light falls through a mask with a binary texture onto a fluorescent plane.",
        "For equal mean luminance in an open part of the cat's window (8 x 8 mm, at least 3 mm from edges) the light"
        f" without scattering is {ratio['qdot545']:.3f} times (Qdot 545) and {ratio['qdot655']:.3f} times (Qdot 655)"
        f" that with scattering, measured from {run.settings.probe_passes} passes. The light is adjusted in the"
        " scene.",
        "The same arrangement. The masks are our own drawings (scripts/draw_masks): a cat under a branch, and a star"
        " of 24 spokes for everything from coarse to fine. The sheet is lit at right angles.",
        [[run.picture("fig11", "The sheet glows through the cut-outs of the card above it. Qdot 545, model paper.")]],
        {"light_without_over_with": ratio},
    )


def pictures(run, key, dot):
    return [
        run.picture(f"{key}_{dot}_paper", f"Qdot {dot}, c = 0.5, scattering, model paper"),
        run.picture(f"{key}_{dot}_without", f"Qdot {dot}, c = 1.0, without scattering"),
        run.picture(f"{key}_{dot}_conserving", f"Qdot {dot}, c = 0.5, scattering, model conserving (own exposure)"),
    ]


def silhouette(run):
    drawing, axes = figure.axes(2)
    numbers = {}
    for axis, (dot, colour) in zip(axes, DOTS.items()):
        for which, style in (("paper", "-"), ("without", "--"), ("conserving", ":")):
            result = run.results[f"fig12_{dot}_{which}"]
            centres, profile, width, error = window_edge(result)
            bright = np.nanmean(profile[centres > PLATEAU])
            axis.plot(centres, profile / bright, style, color=colour, label=f"{which}: {width:.2f} mm")
            entry = numbers.setdefault(f"qdot{dot}", {})
            entry[which] = {
                "edge_width_mm": width,
                "standard_error_mm": error,
                "light_2_mm_in_the_shadow": float(np.interp(-2, centres, profile / bright)),
                "open_luminance_cd_m2": open_luminance(result),
            }
        axis.set_title(f"Qdot {dot}: 10-90 % widths")
        axis.set_xlabel("distance from the mask's edge, bright side positive [mm]")
        axis.legend()
    axes[0].set_ylabel("luminance / luminance of the open part")
    a, b = numbers["qdot545"], numbers["qdot655"]
    last = figure.radius_note(run.results["fig12_545_paper"])
    return page.Section(
        "fig12",
        "Figure 12: a silhouette",
        "With scattering (c = 0.5) light bleeds over the edges of the mask's shadow; without (c = 1.0) they are"
        " sharp.",
        f"10-90 % widths across the window's straight edge, Qdot 545: {a['paper']['edge_width_mm']:.2f} ±"
        f" {a['paper']['standard_error_mm']:.2f} mm with and {a['without']['edge_width_mm']:.2f} ±"
        f" {a['without']['standard_error_mm']:.2f} mm without scattering; Qdot 655: {b['paper']['edge_width_mm']:.2f}"
        f" and {b['without']['edge_width_mm']:.2f} mm. 2 mm into the shadow there is"
        f" {100 * a['paper']['light_2_mm_in_the_shadow']:.1f} % of the light, without scattering"
        f" {100 * a['without']['light_2_mm_in_the_shadow']:.1f} %. Model conserving:"
        f" {a['conserving']['edge_width_mm']:.2f} mm.",
        f"{_bleeds(a, b)} What is left of the width without scattering is that of the density estimate, whose radius"
        f" is {last} in the last pass.",
        [
            pictures(run, "fig12", "545"),
            pictures(run, "fig12", "655"),
            [run.plot("fig12", drawing, "Across the straight right edge of the window, mean over 20 mm along it.")],
        ],
        numbers,
    )


def _bleeds(*dots):
    if all(dot["paper"]["edge_width_mm"] > 1.5 * dot["without"]["edge_width_mm"] for dot in dots):
        return "Same: edges bleed with scattering, and are sharp without."
    return "At these settings the density estimate hides most of the difference."


def star(run):
    drawing, axes = figure.axes(2)
    numbers = {}
    for axis, (dot, colour) in zip(axes, DOTS.items()):
        for which, style in (("paper", "-"), ("without", "--"), ("conserving", ":")):
            periods, contrasts = star_contrast(run.results[f"fig13_{dot}_{which}"])
            axis.plot(periods, contrasts, style, color=colour, marker="o", markersize=3, label=which)
            numbers.setdefault(f"qdot{dot}", {})[which] = {
                "half_contrast_period_mm": half_contrast(periods, contrasts),
                "contrast_at_2_mm": float(np.interp(2, periods, contrasts)),
                "contrast_at_4_mm": float(np.interp(4, periods, contrasts)),
            }
        axis.set_title(f"Qdot {dot}")
        axis.set_xlabel("period of the spokes [mm]")
        axis.set_ylim(0, 1.05)
        axis.legend()
    axes[0].set_ylabel("contrast that is left")
    a, b = numbers["qdot545"], numbers["qdot655"]
    return page.Section(
        "fig13",
        "Figure 13: a fine pattern",
        "A fine pattern blurs with scattering and stays clear without.",
        "Contrast (fundamental of the spokes over that of the mask) at a period of 2 mm:"
        f" {a['paper']['contrast_at_2_mm']:.2f} with and {a['without']['contrast_at_2_mm']:.2f} without scattering"
        f" for Qdot 545, {b['paper']['contrast_at_2_mm']:.2f} and {b['without']['contrast_at_2_mm']:.2f} for Qdot"
        f" 655; at 4 mm {a['paper']['contrast_at_4_mm']:.2f} and {a['without']['contrast_at_4_mm']:.2f}. Model"
        f" conserving at 2 mm: {a['conserving']['contrast_at_2_mm']:.2f}.",
        (
            "Same: scattering takes the contrast of the fine spokes first. The numbers depend on our own pattern."
            if a["paper"]["contrast_at_2_mm"] < 0.8 * a["without"]["contrast_at_2_mm"]
            else "At these settings the density estimate hides most of the difference."
        ),
        [
            pictures(run, "fig13", "545"),
            pictures(run, "fig13", "655"),
            [run.plot("fig13", drawing, "Contrast against the period of the spokes, from the rings of the star.")],
        ],
        numbers,
    )
