# SPDX-License-Identifier: Apache-2.0
"""Files that are more text than list: tools/templates/NAME.j2."""

import jinja2
from expressions import camel, cpp_expr, js_expr, py_expr, quoted
from files import NOTE, TOP

ENVIRONMENT = jinja2.Environment(
    loader=jinja2.FileSystemLoader(TOP / "tools/templates"),
    undefined=jinja2.StrictUndefined,
    trim_blocks=True,
    lstrip_blocks=True,
    keep_trailing_newline=True,
)
ENVIRONMENT.filters |= {"js": js_expr, "py": py_expr, "camel": camel, "quoted": quoted}


def render(defs, name, **more):
    """The file that the template of this name makes of the definitions."""
    ENVIRONMENT.filters["cpp"] = lambda expr: cpp_expr(expr, defs.names)
    ENVIRONMENT.filters["cpp_derived"] = defs.cpp_derived
    numbers, count = defs.golden_numbers()
    pixel, pixel_count = defs.golden_pixel()
    more |= {"golden_numbers": numbers, "golden_count": count, "pixel_numbers": pixel, "pixel_count": pixel_count}
    return ENVIRONMENT.get_template(name + ".j2").render(note=NOTE, defs=defs, **defs.d, **more)
