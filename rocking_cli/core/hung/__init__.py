"""What hangs on a mechanism: loads and ties, walls that cross it, and pivots that crush under them."""
