"""The folder of a sweep."""

import pytest

from holonom.failures import ErrorKind, HolonomError
from holonom.sweeps.dataset import DOCUMENT, _read_document


@pytest.mark.parametrize("content", [None, b"", b"no json", b"\xff"])
def test_a_folder_without_a_document_is_named(content, tmp_path):
    if content is not None:
        (tmp_path / DOCUMENT).write_bytes(content)
    with pytest.raises(HolonomError) as caught:
        _read_document(tmp_path)
    assert (caught.value.kind, caught.value.place) == (ErrorKind.UNRELATED_FOLDER, str(tmp_path))
