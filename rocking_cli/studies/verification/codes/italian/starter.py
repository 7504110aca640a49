"""The site file to start from that `rocking new site` prints."""

STARTER = """\
# A site, to verify a structure of masonry that rocks by the Italian code: NTC 2018 and Circolare 7/2019.
#   rocking new block > block.yaml
#   rocking new site > site.yaml
#   rocking verify block.yaml --site site.yaml
# docs/verification.md has every field, the formulas and their clauses.
code: NTC2018
name: my site
FC: 1.35                      # confidence factor; 1.35 as long as no compressive strength is counted
q: 2.0                        # behaviour factor of the linear method
# The ground, in one of three ways. First: the parameters of the limit state SLV.
ag: 0.20                      # ground acceleration on rock [g]
F0: 2.5                       # amplification of the spectrum
TC: 0.40                      # end of its level part [s]: C_C T_C*
S: 1.2                        # soil and topography: S_S S_T
soil: B                       # A to E, for displacements at long periods; left out, on the safe side
# SLC: {ag: 0.26, F0: 2.5, TC: 0.42, S: 1.2}    # collapse, and damage, by the same four
# SLD: {ag: 0.08, F0: 2.5, TC: 0.36, S: 1.2}
# Second: the hazard, rows of [return period in years, ag in g, F0, T_C* in s]; all limit states follow from it.
# VN: 50                      # nominal life [years]
# CU: 1.0                     # coefficient of use
# topography: T1              # T1 to T4
# hazard: [[30, 0.060, 2.45, 0.27], [101, 0.105, 2.40, 0.29], [475, 0.200, 2.45, 0.32], [2475, 0.330, 2.55, 0.36]]
# Third: ordinates [period in s, acceleration in g] at 5 % damping, from T = 0 on; straight lines between.
# spectrum: [[0, 0.24], [0.13, 0.60], [0.40, 0.60], [0.8, 0.30], [2.4, 0.10], [4.0, 0.036], [8.0, 0.009]]
# Where it does not stand on the ground but in a building (xi1 is a ratio, 0.05 for 5 %):
# floor: {z: 6.0, H: 9.0, T1: 0.40, xi1: 0.05, n: 3}
# T0: 0.1                     # period of an element that vibrates freely before it rocks, such as a parapet [s]
"""
