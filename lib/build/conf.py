"""How Sphinx makes the manuals into one site: lib/build/site calls it."""
project = "Waferhand"
author = "Waferhand"
extensions = ["myst_parser"]
source_suffix = {".md": "markdown"}
root_doc = "index"
html_theme = "furo"
html_title = "Waferhand"
html_copy_source = False
html_show_sourcelink = False
html_show_sphinx = False
# Headings are linked as in the files themselves.
myst_heading_anchors = 4
# Sources and examples are linked as files, and what a folder is, is not a page.
suppress_warnings = ["ref.myst", "myst.header", "misc.highlighting_failure"]
pygments_style = "default"
