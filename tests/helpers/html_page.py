"""A web page as a test reads it: tags with their attributes, and the text; and what every page must be."""

import base64
import re
from html.parser import HTMLParser


class Page(HTMLParser):
    """Tags with their attributes, and the text."""

    def __init__(self, text: str) -> None:
        super().__init__()
        self.source = text
        self.tags: list[tuple[str, dict[str, str | None]]] = []
        self.words: list[str] = []
        self.feed(text)

    def handle_starttag(self, tag, attrs):
        """Note a tag."""
        self.tags.append((tag, dict(attrs)))

    def handle_data(self, data):
        """Note words."""
        self.words.append(data)

    @property
    def text(self) -> str:
        """All words in a row."""
        return " ".join(" ".join(self.words).split())

    def all(self, tag: str) -> list[dict[str, str | None]]:
        """Attributes of all tags of a name."""
        return [attrs for name, attrs in self.tags if name == tag]


def assert_self_contained(page: Page) -> None:
    """No address, no script, no other file."""
    text = re.sub(r"base64,[A-Za-z0-9+/=]+", "", page.source)
    assert not re.search(r"https?:|//|url\(|@import|<script|<link|<iframe|<object|\shref=|\son\w+=", text)
    assert all(attrs["src"].startswith("data:image/png;base64,") for attrs in page.all("img"))
    assert not page.all("a") and not page.all("script")


def assert_pictures_have_words(page: Page, n: int) -> None:
    """So many pictures, each with a description of its own that says its scale."""
    pictures = page.all("img")
    assert len(pictures) == n
    for attrs in pictures:
        assert base64.b64decode(attrs["src"].split(",")[1]).startswith(b"\x89PNG")
        assert len(attrs["alt"]) > 60 and "mm" in attrs["alt"]
    assert len({attrs["alt"] for attrs in pictures}) == n


def assert_structured_for_reading_aloud(page: Page) -> None:
    """A language, one title, named sections, heads of tables that say what they are heads of."""
    assert page.all("html")[0]["lang"] == "en" and len(page.all("h1")) == 1
    ids = {attrs["id"] for _, attrs in page.tags if "id" in attrs}
    assert {attrs["aria-labelledby"] for attrs in page.all("section")} <= ids
    assert all("scope" in attrs for attrs in page.all("th"))
