# SPDX-License-Identifier: GPL-3.0-or-later
"""The page about following: its tables match the operators."""

import pages
import pytest

PAGE = pages.text("follow")


@pytest.mark.parametrize("operator", ["limit_follow", "limit_unbind", "limit_rebind"])
def test_tables_list_the_properties_and_their_defaults(operator):
    section = PAGE.split(f"## `object.{operator}`")[1].split("\n## ")[0]
    table = section.split("| property |")[1].split("\n\n")[0]
    pages.check_properties(table, operator)
