"""Statistics by SciPy, as rows of C++. What another program computes tells whether ours does.

    python3 property_tests/data/statistics.py >property_tests/data/statistics.inc     # SciPy 1.10.1
"""

import random

from scipy import stats

random.seed(1)


def row(what, numbers, expected):
    print(f'{{"{what}", {{{", ".join(repr(float(n)) for n in numbers)}}}, {float(expected)!r}}},')


# More pairs than are counted out: normal, with ties and a correction for continuity.
for spread in (3, 10, 40, 1000):
    for shift in (0, 0.1, 0.4):
        sizes = [random.randint(-spread, spread) / 4 + round(shift * spread) / 4 for _ in range(130)]
        row("wilcoxon", sizes, stats.wilcoxon(sizes, zero_method="wilcox", correction=True, method="approx").pvalue)
# Few without ties: exact.
for count in (5, 9, 25, 50):
    sizes = [random.choice((-1, 1, 1)) * (i + 1) for i in range(count)]
    row("wilcoxon", sizes, stats.wilcoxon(sizes, method="exact").pvalue)
for wins, losses in ((5, 0), (8, 2), (11, 30), (450, 550), (3000, 2900)):
    row("sign_test", [wins, losses], stats.binomtest(wins, wins + losses).pvalue)
for held, of in ((0, 20), (1, 29), (15, 148), (81, 263), (100, 100)):
    interval = stats.binomtest(held, of).proportion_ci(0.95, method="wilson")
    row("wilson_low", [held, of], interval.low)
    row("wilson_high", [held, of], interval.high)
for freedom in (1, 2, 5, 13, 59, 1000):
    row("t_quantile", [freedom], stats.t.ppf(0.975, freedom))
for p in (1e-6, 0.01, 0.3, 0.5, 0.95, 0.99999):
    row("normal_quantile", [p], stats.norm.ppf(p))
for p in (0, 0.1, 0.25, 0.5, 0.9, 1):
    values = [random.randint(0, 50) / 4 for _ in range(12)]
    row("quantile", [p, *values], stats.mstats.mquantiles(values, [p], alphap=1, betap=1)[0])
values = [random.randint(1, 50) / 4 for _ in range(9)]
row("geometric_mean", values, stats.gmean(values))
