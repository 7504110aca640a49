"""What tests of records share."""

import pytest


@pytest.fixture
def write(tmp_path):
    """Write a file and return its path; text with exactly the newlines given."""

    def write(content, name="record.txt"):
        (tmp_path / name).write_bytes(content if isinstance(content, bytes) else content.encode())
        return tmp_path / name

    return write
