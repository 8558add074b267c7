"""Changes base.xml in many small ways and asks xmllint about each; writes verdicts.tsv.

A line is: verdict, start, length, replacement. The document is base.xml with `length` bytes from byte `start`
on replaced (`\\n` is a newline); the verdict is `valid`, `invalid` (by the definition) or `malformed` (not XML).
"""

import os
import random
import subprocess
import tempfile
import xml.parsers.expat

HERE = os.path.dirname(os.path.abspath(__file__))
DTD = os.path.join(HERE, "../../../crates/sophy-xml/SophySystem.dtd")
with open(os.path.join(HERE, "base.xml"), "rb") as file:
    BASE = file.read()


class Element:
    def __init__(self, name, attributes, start):
        self.name, self.attributes, self.start = name, attributes, start
        self.tag_end = BASE.index(b">", start) + 1
        self.end, self.children = 0, []


def elements():
    """All elements of the base with the bytes they take, in document order."""
    found, open_elements = [], []
    parser = xml.parsers.expat.ParserCreate()

    def start(name, attributes):
        element = Element(name, attributes, parser.CurrentByteIndex)
        if open_elements:
            open_elements[-1].children.append(element)
        open_elements.append(element)
        found.append(element)

    def end(_name):
        element = open_elements.pop()
        element.end = BASE.index(b">", parser.CurrentByteIndex) + 1

    parser.StartElementHandler, parser.EndElementHandler = start, end
    parser.Parse(BASE, True)
    return found


def mutations():
    choice = random.Random(1)
    found = elements()
    names = sorted({element.name for element in found} | {"outpuvent"})
    yield 0, 0, b""
    for element in found:
        start, end, tag_end = element.start, element.end, element.tag_end
        text = BASE[start:end]
        closing = text.rindex(b"</")
        inside = text[tag_end - start : closing]

        def renamed(name):
            attributes = text[1 + len(element.name) : tag_end - start]
            return start, end - start, b"<" + name + attributes + inside + b"</" + name + b">"

        yield start, end - start, b""  # without it
        yield start, end - start, text + text  # twice
        yield start, end - start, text[: tag_end - start] + text[closing:]  # empty
        yield renamed(element.name.encode() + b"s")
        yield renamed(choice.choice(names).encode())
        yield tag_end, 0, b"stray"
        yield tag_end, 0, b"<" + choice.choice(names).encode() + b"/>"
        yield start + 1 + len(element.name), 0, b' note="x"'  # an attribute too many
        yield start + closing, end - start - closing, b""  # no closing tag
        yield start, tag_end - start, b""  # no opening tag
        for attribute, value in element.attributes.items():
            written = f' {attribute}="{value}"'.encode()
            at = start + text.index(written)
            yield at, len(written), b""
            yield at, len(written), written + written
            yield at + 1, len(attribute), b"State"
        for first, second in zip(element.children, element.children[1:]):
            swapped = BASE[second.start : second.end] + BASE[first.end : second.start] + BASE[first.start : first.end]
            yield first.start, second.end - first.start, swapped
    for _ in range(150):
        at = choice.randrange(len(BASE))
        yield at, choice.randrange(2), choice.choice([b"", b"<", b">", b"&", b'"', b"/", b"x", b"]]>", b"<!--", b"--"])
    for _ in range(100):
        at = choice.randrange(len(BASE))
        yield at, choice.randrange(1, 40), b""


def verdict(document):
    with tempfile.NamedTemporaryFile(suffix=".xml") as file:
        file.write(document)
        file.flush()
        run = ["xmllint", "--nonet", "--noout", "--dtdvalid", DTD, file.name]
        code = subprocess.run(run, stderr=subprocess.DEVNULL, check=False).returncode
    return {0: "valid", 1: "malformed", 3: "invalid"}[code]


with open(os.path.join(HERE, "verdicts.tsv"), "w", encoding="utf-8") as out:
    for at, length, replacement in sorted(set(mutations())):
        document = BASE[:at] + replacement + BASE[at + length :]
        written = replacement.decode().replace("\n", "\\n")
        out.write(f"{verdict(document)}\t{at}\t{length}\t{written}\n")
