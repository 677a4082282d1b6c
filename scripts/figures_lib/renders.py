"""Renders scenes with stokes, each at most once for the same scene, settings and program."""

import dataclasses
import hashlib
import json
import os
import pathlib
import subprocess
import time

from figures_lib import exr, scenes


@dataclasses.dataclass
class Job:
    """A render. scene, passes, exposure and flags may be functions of the results so far {name: Result}."""

    name: str
    scene: object  # dict, as of scenes.load
    passes: object
    photons: int
    size: tuple  # width, height
    transport: str = "paper"
    seed: int = 1
    exposure: object = None  # EV of the PNG; None: automatic
    flags: object = ()  # more words for the command line
    references: object = ()  # files that flags name
    weight: float = 1.0  # time of a pass, relative to other jobs of its photons and pixels
    expected_passes: int = 0  # where passes is a function

    @property
    def cost(self):
        """In units of its own, for the estimate of the time."""
        passes = self.expected_passes if callable(self.passes) else self.passes
        return self.weight * passes * (self.photons + 0.8 * self.size[0] * self.size[1]) + 3e6


@dataclasses.dataclass
class Result:
    """What a Job gave. processor_s: processor time of the whole process."""

    scene: dict
    exr: pathlib.Path
    png: pathlib.Path
    curve: pathlib.Path  # CSV of --rmse-against, where that was asked for
    stats: dict
    processor_s: float

    def picture(self):
        return exr.read(self.exr)

    @property
    def exposure_ev(self):
        return self.picture().attributes["stokes.exposure_ev"]


class Renderer:
    """Runs jobs and keeps what they give in a folder, by a hash of all that decides it."""

    def __init__(self, stokes, folder, threads=None):
        self.stokes = pathlib.Path(stokes).resolve()
        self.folder = pathlib.Path(folder)
        self.folder.mkdir(parents=True, exist_ok=True)
        self.threads = threads
        self.program = hashlib.sha256(self.stokes.read_bytes()).hexdigest()
        self.results = {}
        self.total = self.done = self.rendered_cost = self.rendered_s = 0.0

    def run(self, jobs):
        """Results of jobs, by name, earlier ones first."""
        self.total = self.done + sum(job.cost for job in jobs)
        for number, job in enumerate(jobs, 1):
            self._say(f"[{number}/{len(jobs)}] {job.name}")
            self.results[job.name] = self._result(job)
            self.done += job.cost
        return self.results

    def _say(self, text):
        remaining = ""
        if self.rendered_cost > 0:
            seconds = (self.total - self.done) * self.rendered_s / self.rendered_cost
            remaining = f"   about {_clock(seconds)} left"
        print(text + remaining, flush=True)

    def _value(self, value):
        return value(self.results) if callable(value) else value

    def _result(self, job):
        scene, passes, exposure = (self._value(v) for v in (job.scene, job.passes, job.exposure))
        flags = [str(word) for word in self._value(job.flags)]
        words = [
            "--passes",
            str(passes),
            "--photons",
            str(job.photons),
            "--size",
            "{}x{}".format(*job.size),
            "--transport",
            job.transport,
            "--seed",
            str(job.seed),
        ]
        if exposure is not None:
            words += ["--exposure", repr(float(exposure))]
        references = [hashlib.sha256(pathlib.Path(r).read_bytes()).hexdigest() for r in self._value(job.references)]
        flag_words = [os.path.basename(word) if os.path.isabs(word) else word for word in flags]
        identity = json.dumps([self.program, scenes.fingerprint(scene), words, flag_words, references])
        key = hashlib.sha256(identity.encode()).hexdigest()[:20]
        files = {kind: self.folder / f"{key}.{kind}" for kind in ("json", "exr", "png", "csv", "scene.json")}
        if not files["json"].exists():
            self._render(job, scene, words, [word.replace("CURVE", str(files["csv"])) for word in flags], files)
        with open(files["json"], encoding="utf-8") as file:
            kept = json.load(file)
        return Result(scene, files["exr"], files["png"], files["csv"], kept["stats"], kept["processor_s"])

    def _render(self, job, scene, words, flags, files):
        scene = dict(scene, comment=f"As rendered for {job.name}.")
        files["scene.json"].write_text(json.dumps(scene, indent=1), encoding="utf-8")
        stats = files["json"].with_suffix(".stats.json")
        command = [
            str(self.stokes),
            "render",
            str(files["scene.json"]),
            *words,
            *flags,
            "-o",
            str(files["exr"]),
            "--png",
            str(files["png"]),
            "--stats",
            str(stats),
            "--quiet",
        ]
        if self.threads:
            command += ["--threads", str(self.threads)]
        start = time.monotonic()
        child = subprocess.Popen(command, stdout=subprocess.DEVNULL)
        try:
            _, status, usage = os.wait4(child.pid, 0)
        except KeyboardInterrupt:
            child.terminate()
            os.wait4(child.pid, 0)
            raise
        code = child.returncode = os.waitstatus_to_exitcode(status)
        if code != 0:
            raise subprocess.CalledProcessError(code, command)
        self.rendered_s += time.monotonic() - start
        self.rendered_cost += job.cost
        kept = {
            "name": job.name,
            "words": words + flags,
            "processor_s": usage.ru_utime + usage.ru_stime,
            "stats": json.loads(stats.read_text(encoding="utf-8")),
        }
        stats.unlink()
        # Last, and by renaming: where this file is, the others are whole.
        unfinished = files["json"].with_suffix(".tmp")
        unfinished.write_text(json.dumps(kept), encoding="utf-8")
        unfinished.replace(files["json"])


def _clock(seconds):
    minutes = int(seconds / 60 + 0.5)
    return (
        f"{minutes // 60} h {minutes % 60:02d} min" if minutes >= 60 else f"{minutes} min" if minutes else "a minute"
    )
