"""What the site has beside docs/: files of the repository that its pages link to, the Rust API, live runs.

A page links to files outside of docs/ by `../FILE`, as in the repository. Here they are at `source/FILE`, and links to
them lead there.
"""

import re
from pathlib import Path, PurePosixPath

from mkdocs.structure.files import File, InclusionLevel

ROOT = Path(__file__).resolve().parent.parent
# Made by website/build: the API documentation of the crates, and pages with runs.
MADE = ROOT / "target" / "site-parts"
OUTSIDE = re.compile(r"\]\(((?:\.\./)+)([^)#\s]+)(#[^)]*)?\)")
ALWAYS = ["CONTRIBUTING.md", "CHANGELOG.md"]
# Findings, pages for people who work on the program, and lists of names come after the others in the search.
INSIDE = re.compile(
    r"findings/|source/|reference/tables/|"
    r"reference/(architecture|extending|self-measurement|releasing|python-api|rust-api|settings)\.md"
)


def _target(page: str, up: str, path: str) -> str | None:
    """The path in the repository of a link on a page; None if it is inside docs/."""
    levels = len(PurePosixPath(page).parents) - 1
    ups = up.count("../")
    return path if ups > levels else None


def on_files(files, config):
    linked = set(ALWAYS)
    for file in files.documentation_pages():
        for _, up, path in _links(file):
            linked.add(path)
    for path in sorted(linked):
        source = ROOT / path
        if source.is_file():
            files.append(File.generated(config, f"source/{path}", abs_src_path=str(source)))
    for part in ["rust", "live"]:
        for source in sorted((MADE / part).rglob("*")):
            if source.is_file():
                uri = f"{part}/{source.relative_to(MADE / part).as_posix()}"
                uri = re.sub(r"\.md$", ".txt", uri)  # the license of a font is no page
                made = File.generated(config, uri, abs_src_path=str(source))
                made.inclusion = InclusionLevel.NOT_IN_NAV
                files.append(made)
    return files


def _links(file):
    text = Path(file.abs_src_path).read_text()
    for match in OUTSIDE.finditer(text):
        path = _target(file.src_uri, match[1], match[2])
        if path is not None:
            yield match, match[1], path


def on_page_markdown(markdown, page, config, files):
    uri = page.file.src_uri
    if INSIDE.match(uri):
        page.meta["search"] = {"boost": 0.3}
    levels = len(PurePosixPath(uri).parents) - 1
    if uri.startswith("source/"):
        # A file of the repository's root links to docs/ as its folder, and to other files beside it.
        return re.sub(r"\]\((docs/)?([^):#\s]+)(#[^)]*)?\)", _from_root, markdown)

    def moved(match):
        path = _target(uri, match[1], match[2])
        return match[0] if path is None else f"]({'../' * levels}source/{path}{match[3] or ''})"

    return OUTSIDE.sub(moved, markdown)


def _from_root(match):
    folder, path, anchor = match[1], match[2], match[3] or ""
    return f"](../{path}{anchor})" if folder else f"]({path}{anchor})"
