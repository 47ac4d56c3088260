"""Sphinx's configuration of the site: `just docs` builds it into target/docs/html."""

import sys
from pathlib import Path

FOLDER = Path(__file__).resolve().parent
sys.path.insert(0, str(FOLDER))

import generate  # noqa: E402
from docutils import nodes  # noqa: E402
from latex2mathml.converter import convert  # noqa: E402
from pybtex.plugin import register_plugin  # noqa: E402
from pybtex.style.formatting.unsrt import Style  # noqa: E402
from pybtex.style.labels import BaseLabelStyle  # noqa: E402


class KeyLabels(BaseLabelStyle):
    """Works are cited by the keys that pages, program and docstrings use."""

    def format_labels(self, sorted_entries):
        return (entry.key for entry in sorted_entries)


class KeyStyle(Style):
    """The bibliography, sorted and labelled by key."""

    default_label_style = KeyLabels
    default_sorting_style = "author_year_title"


register_plugin("pybtex.style.formatting", "keys", KeyStyle)

project = "hertzchain"
author = "hertzchain developers"
copyright = author
version = release = generate.version()

extensions = [
    "myst_nb",
    "sphinx.ext.autodoc",
    "sphinx.ext.autosummary",
    "sphinx.ext.napoleon",
    "sphinx_copybutton",
    "sphinxcontrib.bibtex",
]
exclude_patterns = ["joss/*", "static/*"]
language = "en"

# Markdown: equations as on the pages, headings as targets of links between pages.
myst_enable_extensions = ["colon_fence", "deflist", "dollarmath"]
myst_heading_anchors = 4
# Output of programs has no grammar; a lexer that stumbles over it would warn.
highlight_language = "none"
copybutton_exclude = ".linenos, .gp, .go"

# Notebooks are executed each time: a failing cell is a warning, and warnings are errors.
nb_execution_mode = "force"
nb_execution_timeout = 300
nb_execution_raise_on_error = True

bibtex_bibfiles = ["../references.bib"]
bibtex_default_style = "keys"

autodoc_mock_imports = ["dask", "distributed", "h5py"]
autodoc_typehints = "none"
autodoc_member_order = "bysource"
autosummary_generate = False
napoleon_numpy_docstring = True
napoleon_use_rtype = False
napoleon_use_ivar = True
# Names in type fields of docstrings are words of NumPy's convention, not all of them targets.
nitpicky = False

# Equations are MathML: pages load nothing from elsewhere.
html_math_renderer = "mathml"

html_theme = "pydata_sphinx_theme"
html_title = "hertzchain"
html_static_path = ["static"]
html_css_files = ["site.css"]
# The explorer and the crates' documentation, as docs/build puts them there.
html_extra_path = [path.as_posix() for path in [generate.EXTRA] if path.exists()]
html_theme_options = {
    "show_toc_level": 2,
    "navigation_with_keys": False,
    "secondary_sidebar_items": ["page-toc"],
    "footer_start": ["copyright"],
    "footer_end": ["sphinx-version"],
}
html_sidebars = {"index": []}
html_show_sourcelink = False


def equation(translator, node):
    """Writes an equation, in its line or in a line of its own."""
    inline = isinstance(node, nodes.math)
    text = convert(node.astext(), display="inline" if inline else "block")
    translator.body.append(text if inline else f'<div class="equation">{text}</div>')
    raise nodes.SkipNode


def setup(app):
    """Pages that come from declarations are written before sources are read; links are completed."""
    app.add_html_math_renderer("mathml", (equation, None), (equation, None))
    generate.write(FOLDER)
    app.connect("source-read", generate.complete)
    app.connect("autodoc-process-docstring", generate.complete_docstring)
