"""The folder of a sweep."""

import pytest

from holonom.failures import Failure, HolonomError
from holonom.sweeps.dataset import DOCUMENT, read_document


@pytest.mark.parametrize("content", [None, b"", b"no json", b"\xff"])
def test_a_folder_without_a_document_is_named(content, tmp_path):
    if content is not None:
        (tmp_path / DOCUMENT).write_bytes(content)
    with pytest.raises(HolonomError) as caught:
        read_document(tmp_path)
    assert (caught.value.failure, caught.value.place) == (Failure.FOREIGN_FOLDER, str(tmp_path))
