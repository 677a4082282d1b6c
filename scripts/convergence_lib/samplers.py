"""The samplers that are compared."""

import dataclasses
import re
import subprocess


TRANSPORTS = ("paper", "conserving", "walk")


@dataclasses.dataclass(frozen=True)
class Option:
    """A flag of stokes render and its value; transports: the models that take it."""

    words: tuple
    transports: tuple = TRANSPORTS


@dataclasses.dataclass(frozen=True)
class Sampler:
    """One way to sample, on top of plain for all others. independent: the photons of a pass are independent of one
    another, so that the variance can be split by source. in_best: it is part of best, as `--sampling best` has it.
    same_kernel: its density estimate blurs as plain's does, so that at equal passes both have the same mean."""

    name: str
    options: tuple = ()
    independent: bool = True
    in_best: bool = True
    same_kernel: bool = True

    def flags(self, transport):
        """Of stokes render, for a scene of that model."""
        return sum((option.words for option in self.options if transport in option.transports), ())

    def suits(self, transport):
        """Whether that model has all of it; best has what there is."""
        return self.name == BEST or all(transport in option.transports for option in self.options)


PLAIN = "plain"
BEST = "best"  # all of them together that are in it


def option(*words, transports=TRANSPORTS):
    return (Option(words, transports),)


# A sampler whose flag the program does not know is left out, with a note.
SINGLE = (
    Sampler("wavelengths", option("--wavelengths", "importance")),
    Sampler("branches", option("--branches", "both", transports=("paper", "conserving"))),
    Sampler("distances", option("--distances", "importance", transports=("paper",))),
    Sampler("emission", option("--emission", "aimed"), independent=False),
    Sampler("stratified", option("--emission", "stratified"), independent=False, in_best=False),
    Sampler("direct", option("--direct", "rays")),
    Sampler("radii", option("--radii", "local"), in_best=False, same_kernel=False),
)

OTHER_KERNEL = frozenset(sampler.name for sampler in SINGLE if not sampler.same_kernel)


def known_flags(stokes):
    """The long flags that `stokes render --help` names."""
    text = subprocess.run([str(stokes), "render", "--help"], check=True, capture_output=True, text=True).stdout
    return set(re.findall(r"--[a-z][a-z-]*", text))


def available(known):
    """Plain, best and the single samplers whose flags are known, by name; and the names of those left out. Best names
    every flag, as what it stands for without depends on the transport model."""
    singles = [sampler for sampler in SINGLE if sampler.options[0].words[0] in known]
    together = [sampler for sampler in singles if sampler.in_best]
    best = sum((sampler.options for sampler in together), option("--sampling", "best"))
    plain = option("--sampling", "plain")
    independent = all(sampler.independent for sampler in together)
    found = [Sampler(PLAIN, plain), Sampler(BEST, best, independent)]
    found += [dataclasses.replace(s, options=plain + s.options) for s in singles]
    left_out = [sampler.name for sampler in SINGLE if sampler not in singles]
    return {sampler.name: sampler for sampler in found}, left_out
