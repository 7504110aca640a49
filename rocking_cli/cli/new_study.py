"""Study file that `rocking new study` prints."""

TEMPLATE = """\
# A fragility study: the probability that structures uplift, rock far or overturn, as a function of intensity.
#   rocking new block > block.yaml
#   rocking new study > study.yaml
#   rocking fragility study.yaml --check     # shows what would be run
#   rocking fragility study.yaml --plot pictures
# File names are relative to this file. docs/fragility.md explains every field, and when not to trust a curve.
name: my study
structures: # one curve each
  - block.yaml
  # - file: wall.yaml
  #   vary: # uncertain fields, drawn again in every sample; lognormal and others too
  #     thickness: {normal: {mean: 0.5, deviation: 0.02}}
  #     restitution: {uniform: {low: 0.85, high: 0.93}}
# samples: 10 # number of structures drawn
records: # use at least 20: with fewer, a curve is valid for these motions only, and the output warns of this
  # - records/*.AT2
  # - file: accel.txt # a record whose file does not state its format
  #   dt: 0.01
  #   units: g
  - pulse: sine:1g:0.6s # a pulse instead of a record; levels scale both
  - pulse: sine:1g:1s
  - pulse: sine:1g:1.5s
  - pulse: ricker:1g:0.5s
  - pulse: ricker:1g:0.8s
  - pulse: ricker:1g:1.2s
  - pulse: mavroeidis:1g:0.6s
  - pulse: mavroeidis:1g:0.9s
  - pulse: mavroeidis:1g:1.4s
method: stripes # every record at every level; cloud: each as it is; ida: scaled up to overturning
levels: {measure: PGA, least: 0.1, most: 1.5, count: 15} # in g; or values: [0.2, 0.4, 0.8]
polarities: [1, -1] # both polarities: the ground motion may come from either side
limit_states: [uplift, 0.5, overturning] # 0.5: a rotation of half the critical one
# hazard: # of the site, for an annual rate: [PGA in g, exceedances per year]
#   measure: PGA
#   points: [[0.1, 0.008], [0.4, 0.0006], [1.6, 0.00001]]
"""
