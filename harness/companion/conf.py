"""Sphinx settings for the book and the manual, in English and in Chinese."""

project = "Holonom"
extensions = [
    "myst_parser",
    "sphinx.ext.autodoc",
    "numpydoc",
    "sphinx_click",
    "sphinxcontrib.bibtex",
    "holonom.reference.pages",
    "holonom.companion.directives",
]
root_doc = "index"
exclude_patterns = ["templates", "own"]
gettext_location = gettext_uuid = False
myst_enable_extensions = ["dollarmath", "deflist", "attrs_inline", "attrs_block", "colon_fence", "fieldlist"]
bibtex_bibfiles = ["book/works.bib"]
bibtex_default_style = "plain"
bibtex_reference_style = "author_year"
smartquotes = False  # of code, too
autodoc_default_options = {"members": True, "undoc-members": True, "special-members": "__getitem__, __call__"}
autodoc_typehints_format = "short"
python_use_unqualified_type_names = True
numpydoc_show_class_members = False
man_pages = [("reference/commands", "holonom", "derive, check and simulate mechanical systems", [], 1)]
today_fmt = "%Y-%m-%d"  # in all languages

html_theme = "furo"
html_title = "Holonom"
html_math_renderer = "mathml"
html_static_path = ["static"]
html_css_files = ["holonom.css"]
html_copy_source = html_show_sphinx = html_show_copyright = False
templates_path = ["theme"]  # the place of the theme for other versions of a page, here other languages
