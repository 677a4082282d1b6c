"""Figure 15: tiles with green and red quantum dots; light bleeds over their borders."""

import numpy as np

from figures_lib import camera, figure, figure_tables, measure, page, scenes
from figures_lib.figure import GREEN, MODELS, RED, base, exposure_of, job

KEYS = ("fig15",)

FRACTIONS = (0.25, 0.75)
TILE, BORDERS = 14, (-14, 0, 14)  # [mm]: edge of a tile; x of the borders inside the slab
MIDDLE = 4  # [mm] from a row's middle line that are looked at
REACH, PLATEAU, STEP = 6.6, 4.6, 0.2


def name(fraction, model):
    return f"fig15_{round(100 * fraction):03d}_{model}"


def jobs(settings):
    tiles = base("tiles", settings)

    def scene(fraction):
        return scenes.change(
            tiles, {f"materials.{colour}.fluorescent_fraction": fraction for colour in ("green", "red")}
        )

    return [
        job(
            settings,
            name(fraction, model),
            scene(fraction),
            transport=model,
            exposure=None if fraction == FRACTIONS[-1] else exposure_of(name(FRACTIONS[-1], model)),
        )
        for model in MODELS
        for fraction in reversed(FRACTIONS)
    ]


def emission_rgb(dot):
    """Linear Rec. 709 of a quantum dot's emission, of luminance 1."""
    cie, _ = figure_tables.read_csv("cie/cie1931_2deg_1nm.csv")
    columns = list(cie)
    emission, _ = figure_tables.read_csv(f"fluorophores/qdot{dot}_model.csv")
    power = np.interp(cie[columns[0]], emission["wavelength_nm"], emission["emission"], 0, 0)
    xyz = np.array([np.sum(power * cie[column]) for column in columns[1:4]])
    return np.linalg.solve(measure.XYZ_OF_RGB, xyz / xyz[1])


def unmixed(picture):
    """Luminance [height, width] of the green and of the red quantum dots' light, from the fluorescence."""
    colours = np.stack([emission_rgb("545"), emission_rgb("655")], axis=1)
    amounts = picture.layers["fluorescence"] @ np.linalg.pinv(colours).T
    return amounts[..., 0], amounts[..., 1]


def borders(result, value, side):
    """Profile of value across the borders between columns, the green (side 1) or red (-1) tile positive; see
    measure.edge."""
    height, width = value.shape
    x, z = camera.on_plane(result.scene, width, height, 0)
    row = np.floor((z + 2 * TILE) / TILE)
    in_row = np.abs(z + 2 * TILE - (row + 0.5) * TILE) < MIDDLE
    distance, along = np.full(x.shape, np.nan), np.full(x.shape, np.nan)
    for k, border in enumerate(BORDERS):
        near = in_row & (np.abs(x - border) < TILE / 2) & (row >= 0) & (row <= 3)
        # Tile (column, row) is green where their sum is even; right of border k is column k + 1.
        sign = side * np.where((k + 1 + row) % 2 == 0, 1, -1)
        distance[near] = (sign * (x - border))[near]
        along[near] = (row * len(BORDERS) + k)[near] + (z[near] / 1000)
    return measure.edge(distance, along, value, REACH, STEP * max(1, 320 / width), PLATEAU, pieces=12)


def report(run):
    drawing, axes = figure.axes(2)
    numbers = {}
    for axis, fraction in zip(axes, FRACTIONS):
        for model, style in (("paper", "-"), ("conserving", ":")):
            result = run.results[name(fraction, model)]
            green, red = unmixed(result.picture())
            entry = numbers.setdefault(f"c_{fraction}", {}).setdefault(model, {})
            for word, light, colour, side in (("green", green, GREEN, 1), ("red", red, RED, -1)):
                centres, profile, width, error = borders(result, light, side)
                bright, dark = np.nanmean(profile[centres > PLATEAU]), np.nanmean(profile[centres < -PLATEAU])
                axis.plot(
                    side * centres, profile / bright, style, color=colour, label=f"{word}, {model}: {width:.2f} mm"
                )
                entry[word] = {
                    "edge_width_mm": width,
                    "standard_error_mm": error,
                    "luminance_cd_m2": float(bright),
                    "share_1_mm_beyond": float((np.interp(-1, centres, profile) - dark) / (bright - dark)),
                    "share_in_the_other_tile": float(dark / bright),
                }
        axis.set_title(f"c = {fraction}: 10-90 % widths")
        axis.set_xlabel("distance from the border, green tile positive [mm]")
        axis.legend(fontsize=8)
    axes[0].set_ylabel("luminance of each dot's light / that in its own tile")
    low, high = (numbers[f"c_{fraction}"]["paper"] for fraction in FRACTIONS)
    gain = high["green"]["luminance_cd_m2"] / low["green"]["luminance_cd_m2"]
    numbers["brightness_ratio_paper"] = gain
    rows = [
        [run.picture(name(fraction, model), f"c = {fraction}, {model}") for fraction in FRACTIONS] for model in MODELS
    ]
    return [
        page.Section(
            "fig15",
            "Figure 15: neighbouring tiles",
            "Green fluorescence bleeds into the red tiles at the borders, and red into the green, for c = 0.25 and c"
            " = 0.75.",
            "1 mm beyond its border the light of a green tile still has"
            f" {100 * low['green']['share_1_mm_beyond']:.1f} % (c = 0.25) and"
            f" {100 * high['green']['share_1_mm_beyond']:.1f} % (c = 0.75) of its brightness, a red one's"
            f" {100 * low['red']['share_1_mm_beyond']:.1f} % and {100 * high['red']['share_1_mm_beyond']:.1f} %."
            f" 10-90 % widths, green: {low['green']['edge_width_mm']:.2f} and {high['green']['edge_width_mm']:.2f}"
            f" mm. Three times c is {gain:.2f} times as bright.",
            "Same: light bleeds over the borders, by the same distance for both c (c scales the fluorescence, not"
            " where it leaves), and green shows more than red, being"
            f" {low['green']['luminance_cd_m2'] / low['red']['luminance_cd_m2']:.1f} times as bright. Widths include"
            f" the density estimate's radius, {figure.radius_note(run.results[name(0.25, 'paper')])} in the last"
            " pass.",
            [
                *rows,
                [
                    run.plot(
                        "fig15", drawing, "The two dots' fluorescence, unmixed by their colours, across the borders."
                    )
                ],
            ],
            numbers,
        )
    ]
