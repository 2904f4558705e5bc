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


@pytest.mark.parametrize("content", ["{}", "[]", '{"rows": -1}'])
def test_a_document_of_another_form_is_refused(content, tmp_path):
    (tmp_path / DOCUMENT).write_text(content, encoding="utf-8")
    with pytest.raises(HolonomError) as caught:
        _read_document(tmp_path)
    assert caught.value.kind is ErrorKind.NOT_A_DOCUMENT
