"""The page: sections of pictures, tables of numbers and captions, and figures.json."""

import dataclasses
import html
import json
import math
import pathlib
import shutil

STYLE = """
body { font: 16px/1.5 Georgia, serif; margin: 2em auto; max-width: 1200px; padding: 0 1em; color: #222;
       background: #fcfcfa; }
h1, h2, th, figcaption, nav { font-family: Helvetica, Arial, sans-serif; }
h2 { border-top: 1px solid #ccc; padding-top: 1em; margin-top: 2em; }
.row { display: flex; flex-wrap: wrap; gap: 1em; align-items: flex-start; }
figure { margin: 0; flex: 1 1 0; min-width: 240px; }
figure.wide { flex-basis: 100%; }
figure img { width: 100%; height: auto; display: block; }
figure.rendered img { background: #000; image-rendering: auto; }
figcaption { font-size: 13px; color: #444; padding-top: .3em; }
dl { display: grid; grid-template-columns: max-content 1fr; gap: .2em 1em; }
dt { font-weight: bold; } dd { margin: 0; }
table { border-collapse: collapse; font-size: 14px; }
td, th { border-bottom: 1px solid #ddd; padding: .15em .8em; text-align: left; }
"""


@dataclasses.dataclass
class Picture:
    file: pathlib.Path
    caption: str
    rendered: bool = True  # a render; otherwise a plot
    wide: bool = False


@dataclasses.dataclass
class Section:
    """A figure of the paper. numbers go to figures.json below its key, and into a table."""

    key: str
    title: str
    paper: str  # what the paper shows or reports
    measured: str
    verdict: str  # same or not, and why
    rows: list  # lists of Pictures
    numbers: dict

    def html(self, folder):
        text = [f'<section id="{self.key}"><h2>{html.escape(self.title)}</h2>']
        for row in self.rows:
            text.append('<div class="row">')
            text += [_figure(picture, folder) for picture in row]
            text.append("</div>")
        text.append("<dl>")
        for name, words in (("The paper", self.paper), ("Measured", self.measured), ("Same?", self.verdict)):
            text.append(f"<dt>{name}</dt><dd>{html.escape(words)}</dd>")
        text.append("</dl>")
        if self.numbers:
            text.append("<details><summary>Numbers</summary><table>")
            text += [
                f"<tr><td>{html.escape(self.key + '.' + name)}</td><td>{html.escape(_shown(value))}</td></tr>"
                for name, value in flat(self.numbers)
            ]
            text.append("</table></details>")
        return "\n".join(text + ["</section>"])


def _figure(picture, folder):
    kinds = " ".join(kind for kind, is_kind in (("rendered", picture.rendered), ("wide", picture.wide)) if is_kind)
    source = pathlib.Path(picture.file).relative_to(folder).as_posix()
    return (
        f'<figure class="{kinds}"><img src="{html.escape(source)}" alt="{html.escape(picture.caption)}"'
        f' loading="lazy"><figcaption>{html.escape(picture.caption)}</figcaption></figure>'
    )


def _shown(value):
    if isinstance(value, float):
        return f"{value:.4g}"
    return ", ".join(_shown(v) for v in value) if isinstance(value, (list, tuple)) else str(value)


def flat(numbers, prefix=""):
    """(dotted name, value) of nested dicts."""
    for name, value in numbers.items():
        if isinstance(value, dict):
            yield from flat(value, f"{prefix}{name}.")
        else:
            yield f"{prefix}{name}", value


def finite(value):
    """The same with null in place of numbers that JSON has not."""
    if isinstance(value, dict):
        return {name: finite(member) for name, member in value.items()}
    if isinstance(value, (list, tuple)):
        return [finite(member) for member in value]
    if hasattr(value, "item"):
        value = value.item()
    return None if isinstance(value, float) and not math.isfinite(value) else value


def write(folder, heading, notes, sections, numbers):
    """index.html and figures.json."""
    links = " · ".join(f'<a href="#{s.key}">{html.escape(s.title.split(":")[0])}</a>' for s in sections)
    body = "\n".join(section.html(folder) for section in sections)
    page = (
        f'<!DOCTYPE html>\n<html lang="en"><head><meta charset="utf-8"><title>{html.escape(heading)}</title>'
        f"<style>{STYLE}</style></head><body><h1>{html.escape(heading)}</h1>"
        + "".join(f"<p>{html.escape(note)}</p>" for note in notes)
        + f"<nav>{links}</nav>\n{body}\n</body></html>\n"
    )
    _replace(folder / "index.html", page)
    _replace(folder / "figures.json", json.dumps(finite(numbers), indent=1) + "\n")


def _replace(path, text):
    unfinished = path.with_name(path.name + ".tmp")
    unfinished.write_text(text, encoding="utf-8")
    unfinished.replace(path)


def keep(result, folder, name):
    """Copies a render's PNG to FOLDER/pictures/NAME.png."""
    file = folder / "pictures" / f"{name}.png"
    file.parent.mkdir(exist_ok=True)
    shutil.copyfile(result.png, file)
    return file
