"""The samplers that are compared."""

import dataclasses
import json
import subprocess


@dataclasses.dataclass(frozen=True)
class Option:
    """A flag of stokes render and its value; transports: the models that take it, as the program says."""

    words: tuple
    transports: tuple = ()


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


def option(*words):
    return (Option(words),)


# A sampler whose flag the program does not know is left out, with a note.
SINGLE = (
    Sampler("wavelengths", option("--wavelengths", "importance")),
    Sampler("branches", option("--branches", "both")),
    Sampler("distances", option("--distances", "importance")),
    Sampler("emission", option("--emission", "aimed"), independent=False),
    Sampler("stratified", option("--emission", "stratified"), independent=False, in_best=False),
    Sampler("direct", option("--direct", "rays")),
    Sampler("radii", option("--radii", "local"), in_best=False, same_kernel=False),
)

OTHER_KERNEL = frozenset(sampler.name for sampler in SINGLE if not sampler.same_kernel)


def known_flags(stokes):
    """The flags of the program's settings, each with the transports that have it."""
    text = subprocess.run([str(stokes), "schema", "--settings"], check=True, capture_output=True, text=True).stdout
    settings = json.loads(text).values()
    return {setting["flags"].split(",")[0]: tuple(setting["transports"]) for setting in settings}


def available(known):
    """Plain, best and the single samplers whose flags are known, by name; and the names of those left out. known: as
    known_flags has them. Best names every flag, as what it stands for without depends on the transport model."""

    def of_program(options):
        return tuple(dataclasses.replace(o, transports=known[o.words[0]]) for o in options)

    singles = [
        dataclasses.replace(sampler, options=of_program(sampler.options))
        for sampler in SINGLE
        if sampler.options[0].words[0] in known
    ]
    together = [sampler for sampler in singles if sampler.in_best]
    best = sum((sampler.options for sampler in together), of_program(option("--sampling", "best")))
    plain = of_program(option("--sampling", "plain"))
    independent = all(sampler.independent for sampler in together)
    found = [Sampler(PLAIN, plain), Sampler(BEST, best, independent)]
    found += [dataclasses.replace(s, options=plain + s.options) for s in singles]
    left_out = [s.name for s in SINGLE if s.name not in {single.name for single in singles}]
    return {sampler.name: sampler for sampler in found}, left_out
