"""Ground motions: records, pulses, and their measures."""
