"""The study file to start from that `rocking new study` prints."""

TEMPLATE = """\
# A fragility study: how likely are structures to uplift, to rock far and to overturn, over the intensity?
#   rocking new block > block.yaml
#   rocking new study > study.yaml
#   rocking fragility study.yaml --check     # what would be run
#   rocking fragility study.yaml --plot pictures
# Files are looked for beside this one. docs/fragility.md has every field, and when not to trust a curve.
name: my study
structures: # one curve each
  - block.yaml
  # - file: wall.yaml
  #   vary: # what nobody knows for certain, drawn anew in every sample; lognormal and others too
  #     thickness: {normal: {mean: 0.5, deviation: 0.02}}
  #     restitution: {uniform: {low: 0.85, high: 0.93}}
# samples: 10 # structures drawn from what varies
records: # the more the better: below 20 a curve is of these motions alone, and says so
  # - records/*.AT2
  # - file: accel.txt # one that does not say itself how it is to be read
  #   dt: 0.01
  #   units: g
  - pulse: sine:1g:0.6s # a pulse stands for a record; levels scale both
  - pulse: sine:1g:1s
  - pulse: sine:1g:1.5s
  - pulse: ricker:1g:0.5s
  - pulse: ricker:1g:0.8s
  - pulse: ricker:1g:1.2s
  - pulse: mavroeidis:1g:0.6s
  - pulse: mavroeidis:1g:0.9s
  - pulse: mavroeidis:1g:1.4s
method: stripes # every record at every level; cloud: each as it is; ida: to where it overturns
levels: {measure: PGA, least: 0.1, most: 1.5, count: 15} # in g; or values: [0.2, 0.4, 0.8]
polarities: [1, -1] # both ways round: the ground may come from either side
limit_states: [uplift, 0.5, overturning] # 0.5: a rotation of half the critical one
# hazard: # of the site, for an annual rate: [PGA in g, exceedances a year]
#   measure: PGA
#   points: [[0.1, 0.008], [0.4, 0.0006], [1.6, 0.00001]]
"""
