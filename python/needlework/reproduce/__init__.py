"""Makes the figures of "Granular cooling of hard needles" and compares its claims with them.

M. Huthmann, T. Aspelmeier and A. Zippelius, Phys. Rev. E 60, 654 (1999). `needlework reproduce`
is this package; docs/reproduction.md shows what comes out. Each figure has a function that makes
numbers of finished runs, and one that draws a picture of these numbers:

    from needlework.reproduce import FIGURES, PaperRuns

    runs = PaperRuns("reproduction", "full")      # a folder that needlework reproduce has filled
    result = FIGURES["5a"].measure(runs)          # result.table, result.measurements
    FIGURES["5a"].draw(result.table).savefig("s.pdf")

One module has one family of figures: dilute, fluctuations, ratio, relaxation, flow, dense, large,
alignment, causes, boltzmann, driving, confined, rods, nematic, liquid. runs.py gives the runs,
equation.py simulations of the Boltzmann equation, course.py means over seeds, cells.py fields in
cells, claims.py the verdicts, student.py their intervals. Lengths are in units of the length L of a
needle, masses in that of its mass m, and temperatures in T_tr(0).
"""

from .claims import Claim, Row, read_claims, verdict
from .course import Measured
from .figure import Figure, Measurement, Result
from .figures import FIGURES
from .runs import PAPER, Conditions, FinishedRun, PaperRuns, Point

__all__ = ["FIGURES", "PAPER", "Claim", "Conditions", "Figure", "FinishedRun", "Measured",
           "Measurement", "PaperRuns", "Point", "Result", "Row", "read_claims", "verdict"]
