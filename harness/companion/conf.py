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
exclude_patterns = ["chapters", "templates", "own"]
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
templates_path = ["sidebar"]
BARS = [f"sidebar/{part}.html" for part in ("brand", "search", "scroll-start", "navigation", "scroll-end")]
html_sidebars = {"**": [*BARS[:-1], "language.html", BARS[-1]]}
SERIF = '"Iowan Old Style", "Palatino Linotype", Palatino, "URW Palladio L", "P052", "Book Antiqua", Georgia, serif'
THEME = {  # what the theme takes our colours for
    "font-stack": SERIF,
    "color-background-primary": "var(--paper)",
    "color-background-secondary": "var(--leaf)",
    "color-foreground-primary": "var(--ink)",
    "color-foreground-secondary": "var(--faint)",
    "color-foreground-muted": "var(--faint)",
    "color-background-border": "var(--rule)",
    "color-admonition-title": "var(--accent)",
    "color-admonition-title-background": "var(--leaf)",
    "color-brand-primary": "var(--accent)",
    "color-brand-content": "var(--link)",
}
NAMES = ("paper", "leaf", "ink", "faint", "rule", "link", "accent", "good", "good-leaf", "bad", "bad-leaf")
LIGHT = "#fdfcf9 #f5f2ea #23201b #655e52 #ddd6c8 #1d5687 #8c3b1d #1f6b45 #e6f2ea #a52a1c #fbeae6"
DARK = "#17181b #202226 #e3dfd6 #a8a296 #3a3c42 #8fbfe8 #e5a07f #86d1a6 #1b2c23 #f29a8a #351f1b"
html_theme_options = {
    f"{name}_css_variables": THEME | dict(zip(NAMES, colours.split(), strict=True))
    for name, colours in (("light", LIGHT), ("dark", DARK))
}
