# python3 links.py: in all pages of the repository, each link to a file finds it, and each #anchor its heading.
import os
import re
import sys

top = os.path.normpath(os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", ".."))


def prose(page):
    """The page without its blocks of code, and links without what is written as code."""
    with open(page, encoding="utf-8") as file:
        text = re.sub(r"^```.*?^```", "", file.read(), flags=re.M | re.S)
    return re.sub(r"^ {4}.*$", "", text, flags=re.M)


def anchors(page):
    """GitHub's names of the headings, which docs/site.yml makes the site's, too."""
    names = set()
    for heading in re.findall(r"^#+ +(.*?) *$", prose(page), flags=re.M):
        heading = re.sub(r"\[(.*?)\]\(.*?\)", r"\1", heading)
        names.add(re.sub(r"[^\w -]", "", heading.lower()).replace(" ", "-"))
    return names


links = failures = 0
for folder, folders, files in os.walk(top):
    folders[:] = [name for name in folders if name != "build" and not name.startswith(".")]
    for page in (os.path.join(folder, name) for name in files if name.endswith(".md")):
        for link in re.findall(r"\]\(([^)\s]+)\)", re.sub(r"`[^`]*`", "", prose(page))):
            if "://" in link:
                continue
            links += 1
            path, _, anchor = link.partition("#")
            target = os.path.normpath(os.path.join(folder, path)) if path else page
            if not os.path.exists(target):
                problem = "there is no such file"
            elif anchor and anchor not in anchors(target):
                problem = "there is no such heading"
            else:
                continue
            print("%s: %s: %s" % (os.path.relpath(page, top), link, problem))
            failures += 1
print("%d links, %d of them wrong" % (links, failures))
sys.exit(failures > 0 or links == 0)
