"""The samplers that are compared."""

import dataclasses
import re
import subprocess


@dataclasses.dataclass(frozen=True)
class Sampler:
    """One way to sample, on top of plain for all others. independent: the photons of a pass are independent of one
    another, so that the variance can be split by source. in_best: it is part of best, as `--sampling best` has it.
    same_kernel: its density estimate blurs as plain's does, so that at equal passes both have the same mean."""

    name: str
    flags: tuple = ()  # of stokes render
    independent: bool = True
    in_best: bool = True
    same_kernel: bool = True


PLAIN = "plain"
BEST = "best"  # all of them together that are in it

# A sampler whose flag the program does not know is left out, with a note.
SINGLE = (
    Sampler("wavelengths", ("--wavelengths", "importance")),
    Sampler("branches", ("--branches", "both")),
    Sampler("emission", ("--emission", "aimed"), independent=False),
    Sampler("stratified", ("--emission", "stratified"), independent=False, in_best=False),
    Sampler("direct", ("--direct", "rays")),
    Sampler("radii", ("--radii", "local"), in_best=False, same_kernel=False),
)

OTHER_KERNEL = frozenset(sampler.name for sampler in SINGLE if not sampler.same_kernel)


def known_flags(stokes):
    """The long flags that `stokes render --help` names."""
    text = subprocess.run([str(stokes), "render", "--help"], check=True, capture_output=True, text=True).stdout
    return set(re.findall(r"--[a-z][a-z-]*", text))


def available(known):
    """Plain, best and the single samplers whose flags are known, by name; and the names of those left out. Best names
    every flag, as what it stands for without depends on the transport model."""
    singles = [sampler for sampler in SINGLE if sampler.flags[0] in known]
    together = [sampler for sampler in singles if sampler.in_best]
    flags = sum((sampler.flags for sampler in together), ("--sampling", "best"))
    independent = all(sampler.independent for sampler in together)
    found = [Sampler(PLAIN, ("--sampling", "plain")), Sampler(BEST, flags, independent)]
    found += [dataclasses.replace(s, flags=("--sampling", "plain", *s.flags)) for s in singles]
    left_out = [sampler.name for sampler in SINGLE if sampler not in singles]
    return {sampler.name: sampler for sampler in found}, left_out
