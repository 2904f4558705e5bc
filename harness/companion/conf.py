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
html_sidebars = {
    "**": [
        "sidebar/brand.html",
        "sidebar/search.html",
        "sidebar/scroll-start.html",
        "sidebar/navigation.html",
        "language.html",
        "sidebar/scroll-end.html",
    ]
}
SERIF = '"Iowan Old Style", "Palatino Linotype", Palatino, "URW Palladio L", "P052", "Book Antiqua", Georgia, serif'


def _colours(paper: str, leaf: str, ink: str, faint: str, rule: str, link: str, accent: str) -> dict[str, str]:
    """Return the colours of our parts and those of the theme that they belong to."""
    return {
        **{"paper": paper, "leaf": leaf, "ink": ink, "faint": faint, "rule": rule, "link": link, "accent": accent},
        "color-background-primary": paper,
        "color-background-secondary": leaf,
        "color-foreground-primary": ink,
        "color-foreground-secondary": faint,
        "color-foreground-muted": faint,
        "color-background-border": rule,
        "color-admonition-title": accent,
        "color-admonition-title-background": leaf,
        "color-brand-primary": accent,
        "color-brand-content": link,
    }


LIGHT = _colours("#fdfcf9", "#f5f2ea", "#23201b", "#655e52", "#ddd6c8", "#1d5687", "#8c3b1d")
DARK = _colours("#17181b", "#202226", "#e3dfd6", "#a8a296", "#3a3c42", "#8fbfe8", "#e5a07f")
html_theme_options = {
    "light_css_variables": LIGHT
    | {"good": "#1f6b45", "good-leaf": "#e6f2ea", "bad": "#a52a1c", "bad-leaf": "#fbeae6", "font-stack": SERIF},
    "dark_css_variables": DARK | {"good": "#86d1a6", "good-leaf": "#1b2c23", "bad": "#f29a8a", "bad-leaf": "#351f1b"},
}
