"""What is estimated from a few renders, with its uncertainty."""

import math
from statistics import NormalDist

import numpy as np


def _continued_fraction(a, b, x):
    """Of the incomplete beta function, by Lentz's method; Abramowitz and Stegun, 26.5.8."""
    tiny = 1e-300

    def away(value):
        return value if abs(value) > tiny else tiny

    c, d = 1.0, 1 / away(1 - (a + b) * x / (a + 1))
    fraction = d
    for m in range(1, 10000):
        for step in (
            m * (b - m) * x / ((a + 2 * m - 1) * (a + 2 * m)),
            -(a + m) * (a + b + m) * x / ((a + 2 * m) * (a + 2 * m + 1)),
        ):
            d = 1 / away(1 + step * d)
            c = away(1 + step / c)
            fraction *= c * d
        if abs(c * d - 1) < 1e-13:
            break
    return fraction


def beta_share(a, b, x):
    """The regularized incomplete beta function I_x(a, b)."""
    if x <= 0 or x >= 1:
        return 0.0 if x <= 0 else 1.0
    front = math.exp(math.lgamma(a + b) - math.lgamma(a) - math.lgamma(b) + a * math.log(x) + b * math.log1p(-x))
    if x < (a + 1) / (a + b + 2):
        return front * _continued_fraction(a, b, x) / a
    return 1 - front * _continued_fraction(b, a, 1 - x) / b


def f_exceeded(f, a, b):
    """Probability that an F variable of a and b degrees of freedom is larger than f."""
    return beta_share(b / 2, a / 2, b / (b + a * f))


def sigmas(probability):
    """How many standard deviations a normal variable is from its mean, on either side, with that probability."""
    return -NormalDist().inv_cdf(max(probability, 1e-300) / 2)


def least_of(probabilities):
    """Probability that the least of as many independent ones would be as small (Sidak): an upper bound for those that
    depend on one another as the differences of layers do."""
    least = min(probabilities, default=1.0)
    return -math.expm1(len(probabilities) * math.log1p(-least)) if least < 1 else 1.0


def dimensions(samples):
    """Of samples [count, values]: how many independent normal variables of equal variance would spread as their sum of
    squares does, (tr S)^2 / tr S^2 with S their covariance. At most count - 1, so too low for samples that vary in
    many ways."""
    centred = samples - samples.mean(axis=0)
    gram = centred @ centred.T
    return float(np.trace(gram) ** 2 / np.sum(gram**2)) if np.any(gram) else 1.0


def dimensions_unbiased(samples):
    """The same from an unbiased estimate of tr S^2 (Bai and Saranadasa, Effect of high dimension, Statistica Sinica 6,
    1996, eq. 3.3): right on average, but uncertain. Between 1 and the number of values; 1 for two samples."""
    n = len(samples) - 1
    centred = samples - samples.mean(axis=0)
    gram = centred @ centred.T / n
    trace, square = float(np.trace(gram)), float(np.sum(gram**2))
    if n < 2 or trace == 0:
        return 1.0
    wanted = n**2 / ((n + 2) * (n - 1)) * (square - trace**2 / n)
    both = trace**2 - 2 * wanted / n
    return min(max(both / wanted, 1.0), centred.shape[1]) if wanted > 0 else float(centred.shape[1])


def zero_mean(samples):
    """Probability that samples [count, values] of mean zero have a mean as far from it, in the sum of squares over all
    values: Dempster's test (A significance test for the separation of two highly multivariate small samples,
    Biometrics 16, 1960), which needs fewer samples than values. With one value it is Student's t. The dimensions are
    underestimated, so the probability is too large rather than too small."""
    count = len(samples)
    mean = samples.mean(axis=0)
    spread = np.sum((samples - mean) ** 2) / (count - 1)
    if spread == 0:
        return 1.0 if not np.any(mean) else 0.0
    freedom = dimensions(samples)
    return f_exceeded(float(count * np.sum(mean**2) / spread), freedom, freedom * (count - 1))


def jackknife(function, count):
    """function(indices) -> numbers, of all of count samples, and their standard errors (leave one out)."""
    everything = np.arange(count)
    value = np.asarray(function(everything), float)
    if count < 2:
        return value, np.full_like(value, np.nan)
    without = np.array([function(np.delete(everything, k)) for k in everything], float)
    return value, np.sqrt((count - 1) / count * np.sum((without - without.mean(axis=0)) ** 2, axis=0))


def line(x, y):
    """Slope of y over x by least squares."""
    x = np.asarray(x, float)
    return float(np.sum((x - x.mean()) * (y - np.mean(y))) / np.sum((x - x.mean()) ** 2))


def variance_of_mean(samples):
    """Mean over the values of the variance of the mean of samples [count, values], and the standard error of what is
    left when it is taken off the mean square error of that very mean: both the estimate and the error vary."""
    count = len(samples)
    deviations = samples - samples.mean(axis=0)
    variance = float(np.mean(np.sum(deviations**2, axis=0))) / (count * (count - 1))
    return variance, variance * math.sqrt(2 / dimensions_unbiased(samples) * count / (count - 1))


def own_square(samples):
    """Square of the expectation of samples [count, values], mean over the values: that of their mean, without the part
    that is its variance. Can be negative by chance."""
    variance, _ = variance_of_mean(samples)
    return float(np.mean(samples.mean(axis=0) ** 2)) - variance
