"""Checks the pages of a course (`sixfold lessons --export`) in headless Chromium, opened from a disk.

    python3 tests/browser/check_site.py SIXFOLD
"""

import pathlib
import subprocess
import sys
import tempfile

from browser import Browser
from check_explorer import Page, answer_question, check, check_quiet

WIDTHS = (1440, 1024, 864, 768, 390)
PAGES = ("index.html", "half-edge.html", "teachers.html", "lessons/index.html", "lessons/flip.html", "lessons/lab.html", "lessons/lab-solutions.html")


def open_page(browser, path):
    browser.open(path)
    browser.wait("return document.readyState === 'complete'")


def check_widths(browser, course):
    for width in WIDTHS:
        browser.devtools("Emulation.setDeviceMetricsOverride", width=width, height=900, deviceScaleFactor=1, mobile=width < 500)
        for name in PAGES:
            open_page(browser, course / name)
            wide = browser.run("return document.documentElement.scrollWidth - innerWidth")
            check(wide <= 0, name, "at", width, "px is", wide, "px too wide")
            if name == "lessons/flip.html":
                if width <= 960:
                    browser.run("document.querySelector('#explorer button').click()")
                shown = browser.run("const box = document.querySelector('iframe').getBoundingClientRect(); return box.width > 300 && box.height > 300")
                check(shown, "the explorer is not shown at", width)


def check_progress(browser, course, sixfold):
    page = Page(browser, sixfold, None)
    progress = "return document.querySelector('a[href=\"flip.html\"]').parentElement.querySelector('.progress').textContent"
    page.open(course / "explorer.html", "#lesson=flip")
    open_page(browser, course / "lessons/index.html")
    check(browser.run(progress) == "", "progress before an answer", browser.run(progress))
    page.open(course / "explorer.html", "#lesson=flip")
    lesson = next(one for one in page.lessons if one["name"] == "flip")
    question = next(part for part in lesson["parts"] if "question" in part)
    answer_question(page, question)
    browser.wait("return (localStorage.getItem('sixfold-explorer') ?? '').includes(arguments[0])", question["id"])
    open_page(browser, course / "lessons/index.html")
    count = sum("question" in part for part in lesson["parts"])
    check(browser.run(progress) == f"1 of {count}", browser.run(progress))
    # Anything may be in the storage.
    for kept in ("null", "7", "{", '{"course": {"answers": null}}', '{"course": {"answers": {"x": 1}}}'):
        browser.run("localStorage.setItem('sixfold-explorer', arguments[0])", kept)
        open_page(browser, course / "lessons/index.html")
        check(browser.run(progress) == "", kept, browser.run(progress))


def main():
    sixfold = sys.argv[1]
    with tempfile.TemporaryDirectory() as scratch:
        course = pathlib.Path(scratch) / "a course"
        subprocess.run([sixfold, "lessons", "--export", course], check=True, stdout=subprocess.DEVNULL)
        browser = Browser()
        try:
            for part in (lambda: check_widths(browser, course), lambda: check_progress(browser, course, sixfold)):
                part()
                check_quiet(browser)
        finally:
            browser.close()
    print("the pages of the course do what they should")


if __name__ == "__main__":
    main()
