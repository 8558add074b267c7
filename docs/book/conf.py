# `sphinx-build docs/book OUT` with myst-parser installed. The pages are plain Markdown and read well without it.
project = "Sophy"
extensions = ["myst_parser"]
myst_heading_anchors = 3
root_doc = "index"
