"""The chapters, one a module with a template of the same name.

Each has a function `chapter(root)` that returns a `holonom.companion.chapter.Chapter`: the runs that it needs, of those
in `holonom.companion.runs` or of any function of a module, and a function that makes the page's content, figures and
sources of their results. `holonom.companion.paper` gives the chapters their order.
"""
