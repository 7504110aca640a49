"""What is made of a ground motion before it shakes anything: read, corrected, turned, carried up to a floor."""
