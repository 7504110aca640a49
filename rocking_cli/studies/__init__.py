"""Studies: each computes one result, from many histories or from a mechanism over a range; none prints anything."""
