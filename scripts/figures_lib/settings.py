"""How large the figures are made."""

import dataclasses


@dataclasses.dataclass
class Settings:
    """What all renders have in common."""

    name: str
    passes: int
    photons: int
    width: int
    height: int
    truth_passes: int
    radius_scale: float = 1.0  # of the scenes' own radius; larger where there are fewer photons
    probe_passes: int = 16  # of the renders whose brightness or time is measured beforehand
    curve_seeds: int = 4  # error curves that are averaged

    @property
    def size(self):
        return self.width, self.height

    @property
    def half(self):
        """For error curves, whose slopes do not depend on the number of pixels."""
        return self.width // 2, self.height // 2

    @property
    def half_square(self):
        side = self.square[0] // 2
        return side, side

    @property
    def square(self):
        """A square picture of as many pixels."""
        side = round((self.width * self.height) ** 0.5)
        return side, side


FULL = Settings("full", passes=1024, photons=262144, width=640, height=480, truth_passes=10000, probe_passes=64)
QUICK = Settings(
    "quick", passes=64, photons=65536, width=256, height=192, truth_passes=512, radius_scale=1.6, curve_seeds=4
)
TINY = Settings(
    "tiny", passes=4, photons=4096, width=40, height=30, truth_passes=8, radius_scale=5, probe_passes=2, curve_seeds=1
)
