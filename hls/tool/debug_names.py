# SPDX-License-Identifier: Apache-2.0
"""Names of C++ variables and of structs' members, out of the debug information of LLVM's textual IR."""

from __future__ import annotations

import re

_ENTRY = re.compile(r"^!(\d+) = (?:distinct )?!(DI\w+)\((.*)\)$")
_LIST = re.compile(r"^!(\d+) = (?:distinct )?!\{(.*)\}$")
_FIELD = re.compile(r'(\w+): ("(?:[^"\\]|\\.)*"|[^,]+)')


class DebugNames:
    def __init__(self, text: str):
        self._entries: dict[str, tuple[str, dict[str, str]]] = {}
        self._lists: dict[str, list[str]] = {}
        for line in text.splitlines():
            if not line.startswith("!"):
                continue
            if entry := _ENTRY.match(line):
                fields = {k: v.strip('"') for k, v in _FIELD.findall(entry[3])}
                self._entries["!" + entry[1]] = (entry[2], fields)
            elif items := _LIST.match(line):
                self._lists["!" + items[1]] = [i.strip() for i in items[2].split(",") if i.strip()]

    def variable(self, key: str) -> str:
        """The name of a DILocalVariable."""
        kind, fields = self._entries.get(key, ("", {}))
        return fields.get("name", "") if kind == "DILocalVariable" else ""

    def arguments(self, subprogram: str) -> dict[int, tuple[str, str]]:
        """A function's arguments by their numbers from 1: name, and key of the type."""
        found = {}
        for kind, fields in self._entries.values():
            if kind == "DILocalVariable" and "arg" in fields and fields.get("scope") == subprogram:
                found[int(fields["arg"])] = (fields["name"], fields["type"])
        return found

    def _stripped(self, key: str) -> tuple[str, dict[str, str]]:
        """A type without references, const and typedefs."""
        kind, fields = self._entries.get(key, ("", {}))
        while kind == "DIDerivedType" and fields.get("tag") in (
            "DW_TAG_reference_type",
            "DW_TAG_pointer_type",
            "DW_TAG_restrict_type",
            "DW_TAG_const_type",
            "DW_TAG_typedef",
        ):
            kind, fields = self._entries.get(fields["baseType"], ("", {}))
        return kind, fields

    def members(self, key: str) -> list[tuple[str, str]] | None:
        """Names and types of a struct's members; None of what is no struct."""
        kind, fields = self._stripped(key)
        if kind != "DICompositeType" or fields.get("tag") == "DW_TAG_array_type":
            return None
        found = []
        for item in self._lists.get(fields.get("elements", ""), []):
            member_kind, member = self._entries.get(item, ("", {}))
            if member_kind == "DIDerivedType" and member.get("tag") == "DW_TAG_member":
                found.append((member["name"], member["baseType"]))
        return found

    def element(self, key: str) -> str:
        """The type of an array's elements."""
        return self._stripped(key)[1].get("baseType", "")

    def is_signed(self, key: str) -> bool:
        return self._stripped(key)[1].get("encoding") == "DW_ATE_signed"
