"""Fails if a link of the Markdown documents below a folder leads to no file: check_links.py FOLDER"""

import pathlib
import re
import sys
from urllib.parse import unquote

folder = pathlib.Path(sys.argv[1])
documents = sorted(folder.rglob("*.md"))
dead = [
    f"{document.relative_to(folder)}: {target}"
    for document in documents
    for target in re.findall(r"\]\(([^)#\s]+)[^)]*\)", document.read_text())
    if not re.match(r"[a-z]+:", target) and not (document.parent / unquote(target)).exists()
]
if dead or not documents:
    sys.exit("dead links:\n" + "\n".join(dead) if dead else f"{folder}: no documents")
