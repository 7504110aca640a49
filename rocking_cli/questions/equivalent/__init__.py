"""`equivalent`: the equivalent pulses of several structures."""
