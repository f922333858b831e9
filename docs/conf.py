"""How Sphinx builds the site: ``make docs``.

The source folder is the whole checkout, so that a link between two Markdown files works in the site as it does in the
repository; ``include_patterns`` says which of its files are pages.
"""

from __future__ import annotations

import pin_metaik
from docs.site import examples

project = "pin_metaik"
author = copyright = "The pin_metaik authors"
release = version = pin_metaik.__version__

root_doc = "docs/index"
include_patterns = ["docs/**.md", "docs/**.rst", "benchmarks/**.md", "CHANGELOG.md", ".github/CONTRIBUTING.md"]
exclude_patterns = [
    ".venv",
    "build",
    "out",
    "docs/comparison/README.md",
    "**/GALLERY_HEADER.rst",
    "**/sg_execution_times.rst",
]
extensions = [
    "myst_parser",
    "sphinx.ext.autodoc",
    "sphinx.ext.autosummary",
    "sphinx.ext.napoleon",
    "sphinx_copybutton",
    "sphinx_design",
    "sphinx_gallery.gen_gallery",
    "docs.site.api",
    "docs.site.entrance",
    "docs.site.examples",
    "docs.site.layers",
    "docs.site.mathml",
]

myst_enable_extensions = ["colon_fence", "deflist", "dollarmath"]
myst_heading_anchors = 4
suppress_warnings = [
    "config.cache",  # functions of this file in sphinx_gallery_conf
    "ref.python",  # names that several modules have, where a docstring does not say whose
]

autosummary_generate = False
autodoc_default_options = {"members": True, "undoc-members": False}
autodoc_typehints = "signature"
autodoc_typehints_format = "short"
autodoc_member_order = "bysource"
autodoc_class_signature = "mixed"
python_display_short_literal_types = True
python_maximum_signature_line_length = 100
napoleon_numpy_docstring = False
napoleon_use_ivar = True

sphinx_gallery_conf = {
    "examples_dirs": examples.stage(),
    "gallery_dirs": "docs/gallery",
    "filename_pattern": r"/\d\d_\w+\.py",
    "within_subsection_order": "FileNameSortKey",
    "reset_argv": examples.arguments,
    "image_scrapers": (examples.pictures,),
    "reset_modules": (),
    "abort_on_example_error": True,
    "remove_config_comments": True,
    "download_all_examples": False,
    "show_signature": False,
    "min_reported_time": 10_000,
    "thumbnail_size": (400, 280),
    "default_thumb_file": None,
}

html_math_renderer = "mathml"
html_theme = "pydata_sphinx_theme"
html_title = "pin_metaik"
html_static_path = ["site/static"]
html_css_files = ["site.css"]
html_show_sourcelink = False
html_copy_source = False
html_theme_options = {
    "navbar_align": "left",
    "header_links_before_dropdown": 6,
    "show_toc_level": 2,
    "footer_start": ["copyright"],
    "footer_end": [],
    "secondary_sidebar_items": ["page-toc"],
    "pygments_light_style": "a11y-high-contrast-light",
    "pygments_dark_style": "a11y-high-contrast-dark",
}
