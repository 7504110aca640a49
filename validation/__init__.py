"""What the tool says, compared with shake-table tests, simulated traces and another engine. No part of the package."""
