# Where the paper's figures find the bars of phases.
from analysis.core.phases import FILLS, LABELS, bar, legend
