"""What the tool says, held against shake-table tests, simulated traces and another engine. No part of the package."""
