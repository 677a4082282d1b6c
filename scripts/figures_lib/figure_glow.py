"""Figures 18 and 19: a sphere in the shadow, lit by the fluorescence of two prisms."""

import colorsys

import numpy as np

from figures_lib import camera, measure, page, scenes
from figures_lib.figure import MODELS, base, exposure_of, job

KEYS = ("fig18", "fig19")

FRACTIONS = {"fig18": 0.5, "fig19": 1.0}
CLOSE_UP = {"left": 0.33, "top": 0.5, "width": 0.34, "height": 0.34}
PRISMS = ("tall prism", "low prism")


def jobs(settings):
    glow, found = base("glow", settings), []
    for model in MODELS:
        for key, fraction in FRACTIONS.items():
            whole = scenes.change(glow, {f"materials.{c}.fluorescent_fraction": fraction for c in ("green", "red")})
            close = scenes.change(whole, {"camera.crop": CLOSE_UP})
            found.append(
                job(
                    settings,
                    f"{key}_{model}",
                    whole,
                    transport=model,
                    exposure=None if key == "fig18" else exposure_of(f"fig18_{model}"),
                )
            )
            found.append(
                job(
                    settings,
                    f"{key}_close_{model}",
                    close,
                    transport=model,
                    exposure=None if key == "fig18" else exposure_of(f"fig18_close_{model}"),
                )
            )
        alone = scenes.without_shapes(scenes.change(glow, {"camera.crop": CLOSE_UP}), PRISMS)
        found.append(
            job(
                settings, f"fig18_alone_{model}", alone, transport=model, exposure=exposure_of(f"fig18_close_{model}")
            )
        )
    return found


def sides(result):
    """Side of the sphere -> mean linear Rec. 709 [3]: towards the green prism (-x), the red (+x)."""
    picture = result.picture()
    sphere = next(shape for shape in result.scene["shapes"] if shape["name"] == "sphere")
    normal = camera.on_sphere(
        result.scene,
        picture.width,
        picture.height,
        sphere["transform"][0]["translate_mm"],
        0.96 * sphere["radius_mm"],
    )
    upper = normal[..., 1] > -0.3
    return {
        "green_side": picture.rgb[(normal[..., 0] < -0.6) & upper].mean(axis=0),
        "red_side": picture.rgb[(normal[..., 0] > 0.6) & upper].mean(axis=0),
    }


def described(rgb):
    """Luminance, chromaticity and hue of a colour; the hue of what Rec. 709 can show of it."""
    hue, saturation, _ = colorsys.rgb_to_hsv(*np.maximum(rgb, 0))
    return {
        "luminance_cd_m2": float(rgb @ measure.XYZ_OF_RGB[1]),
        "xy": measure.chromaticity(rgb),
        "hue_deg": 360 * hue,
        "saturation": saturation,
    }


def report(run):
    return [section(run, key, fraction) for key, fraction in FRACTIONS.items()]


def section(run, key, fraction):
    numbers = {}
    for model in MODELS:
        alone = sides(run.results[f"fig18_alone_{model}"])
        for side, rgb in sides(run.results[f"{key}_close_{model}"]).items():
            entry = numbers.setdefault(model, {})[side] = described(rgb)
            without = described(alone[side])
            entry["without_prisms"] = without
            entry["times_without_prisms"] = (
                entry["luminance_cd_m2"] / without["luminance_cd_m2"] if without["luminance_cd_m2"] > 0 else None
            )
    rows = []
    for model in MODELS:
        row = [
            run.picture(f"{key}_{model}", f"c = {fraction}, {model}"),
            run.picture(f"{key}_close_{model}", f"Close-up, {model}"),
        ]
        if key == "fig18":
            row.append(run.picture(f"fig18_alone_{model}", f"Close-up without the prisms, same exposure, {model}"))
        rows.append(row)
    green, red = numbers["paper"]["green_side"], numbers["paper"]["red_side"]
    more = min(green["times_without_prisms"] or 0, red["times_without_prisms"] or 0) > 1.5
    return page.Section(
        key,
        f"Figure {key[3:]}: light from the prisms, c = {fraction}",
        "A white sphere in the shadow of an occluder before the lamp is lit by the fluorescence of two prisms of"
        " unequal height.",
        f"The sphere's side towards the green prism: {green['luminance_cd_m2']:.3g} cd/m², hue"
        f" {green['hue_deg']:.0f}°, {_times(green)}; towards the red prism: {red['luminance_cd_m2']:.3g} cd/m², hue"
        f" {red['hue_deg']:.0f}°, {_times(red)}. Model conserving: {_times(numbers['conserving']['green_side'])} and"
        f" {_times(numbers['conserving']['red_side'])}.",
        (
            "Same: the sphere is lit by the fluorescence, green on one side and red on the other."
            if more
            else "At these settings the sphere's light is mostly noise."
        )
        + " Without the prisms it has only the black light's violet from the floor. The red glow is weaker to the eye"
        " than the green of as many photons. Both c are with subsurface scattering.",
        rows,
        numbers,
    )


def _times(side):
    return (
        f"{side['times_without_prisms']:.1f} times its luminance without prisms"
        if side["times_without_prisms"]
        else "dark without prisms"
    )
