"""Scene files of scenes/ and variants of them."""

import copy
import hashlib
import json
import pathlib

SCENES = pathlib.Path(__file__).resolve().parent.parent.parent / "scenes"


def load(name):
    """scenes/NAME.json as a dict whose files have absolute paths."""
    return load_file(SCENES / f"{name}.json")


def load_file(path):
    """The same of any scene file."""
    with open(path, encoding="utf-8") as file:
        scene = json.load(file)
    scene.pop("$schema", None)
    _resolve(scene, pathlib.Path(path).resolve().parent)
    return scene


def _resolve(node, folder):
    """Makes every file, and every texture, below a node absolute."""
    for key, value in node.items() if isinstance(node, dict) else enumerate(node):
        if key in ("file", "texture") and isinstance(value, str):
            node[key] = str((folder / value).resolve())
        elif isinstance(value, (dict, list)):
            _resolve(value, folder)


def change(scene, changes):
    """A copy with other values: {"materials.plane.fluorescent_fraction": 1, ..}. Lists are entered by the name of a
    member or by its index; None removes a value."""
    scene = copy.deepcopy(scene)
    for path, value in changes.items():
        node = scene
        *way, last = path.split(".")
        for word in way:
            node = node[_place(node, word)]
        if value is None:
            del node[_place(node, last)]
        else:
            node[_place(node, last)] = value
    return scene


def _place(node, word):
    if not isinstance(node, list):
        return word
    for index, member in enumerate(node):
        if isinstance(member, dict) and member.get("name") == word:
            return index
    return int(word)


def without_shapes(scene, names):
    """A copy without the shapes of those names."""
    scene = copy.deepcopy(scene)
    present = {shape.get("name") for shape in scene["shapes"]}
    if not set(names) <= present:
        raise KeyError(f"no shape named {sorted(set(names) - present)}")
    scene["shapes"] = [shape for shape in scene["shapes"] if shape.get("name") not in names]
    return scene


def fingerprint(scene):
    """Text that changes when the scene, or the content of a file it names, does; comments do not count."""

    def of(node):
        if isinstance(node, dict):
            return {
                key: _content(value) if key in ("file", "texture") and isinstance(value, str) else of(value)
                for key, value in node.items()
                if key != "comment"
            }
        return [of(value) for value in node] if isinstance(node, list) else node

    return json.dumps(of(scene), sort_keys=True)


def _content(path):
    return hashlib.sha256(pathlib.Path(path).read_bytes()).hexdigest()
