"""Small copies of the pictures for scenes/README.md."""

from PIL import Image

WIDTH = 320
PICTURES = (
    "fig1a_paper",
    "fig1b_paper",
    "fig1c_paper",
    "fig11",
    "fig12_545_paper",
    "fig12_545_without",
    "fig13_655_paper",
    "fig13_655_without",
    "fig15_025_paper",
    "fig15_075_paper",
    "fig16_x1_paper",
    "fig17_x1_paper",
    "fig17_x2_paper",
    "fig18_paper",
    "fig18_close_paper",
)
PLOTS = ("fig12", "fig14", "fig17")
COLOURS = 128


def write(folder, gallery):
    """FOLDER/pictures and plots, small and of few colours, to the folder gallery, where they exist."""
    gallery.mkdir(exist_ok=True)
    names = [folder / "pictures" / f"{name}.png" for name in PICTURES]
    names += [folder / "plots" / f"{name}.png" for name in PLOTS]
    for source in names:
        if not source.exists():
            continue
        image = Image.open(source).convert("RGB")
        width = WIDTH if source.parent.name == "pictures" else 2 * WIDTH
        image = image.resize((width, round(image.height * width / image.width)), Image.LANCZOS)
        name = source.name if source.parent.name == "pictures" else f"plot_{source.name}"
        image.quantize(COLOURS).save(gallery / name, optimize=True)
