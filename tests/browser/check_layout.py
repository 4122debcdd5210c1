"""Opens pages in headless Chromium at four widths, light and dark, and as they are printed, and looks for faults that a
reader sees: texts that overlap or are cut, small or faint letters, pages that are almost empty, requests to the
network, messages on the console.

    python3 tests/browser/check_layout.py PAGE...

Everything that is folded is opened first. On paper, it is as the page prints it.
"""

import base64
import json
import pathlib
import re
import subprocess
import sys
import tempfile

from browser import Browser

WIDTHS = (1440, 1024, 768, 390)
# The width of an A4 page between its margins, in CSS pixels.
PAPER_WIDTHS = {"portrait": 718, "landscape": 1047}
# The least sizes of letters: 11 pixels on a screen, 7 points on paper.
LEAST_SIZE = {"screen": 11, "print": 7 / 0.75}
LEAST_CONTRAST = 4.5
# A printed sheet with fewer words is almost empty, unless it is the last. The texts of figures count.
FEWEST_WORDS = 25

FAULTS = """
const [least, leastContrast, isPaper] = arguments;
const faults = [];
const say = (fault, node) => {
    const text = node.textContent.trim().replace(/\\s+/g, ' ').slice(0, 60);
    const section = node.closest('[id]')?.id ?? '';
    faults.push(`${fault}: “${text}” in ${section}`);
};
const visible = (element) => element.checkVisibility({checkVisibilityCSS: true, checkOpacity: true});
const number = (text) => text.match(/[\\d.]+/g).map(Number);
const luminance = ([r, g, b]) => {
    const [x, y, z] = [r, g, b].map((v) => (v /= 255) <= .04045 ? v / 12.92 : ((v + .055) / 1.055) ** 2.4);
    return .2126 * x + .7152 * y + .0722 * z;
};
const contrast = (a, b) => {
    const [low, high] = [luminance(a), luminance(b)].sort((x, y) => x - y);
    return (high + .05) / (low + .05);
};
const paper = number(getComputedStyle(document.body).backgroundColor).slice(0, 3);
const ground = (element) => {
    for (let e = element; e; e = e.parentElement) {
        const colour = number(getComputedStyle(e).backgroundColor);
        if (colour.length === 3 || colour[3] === 1) return colour.slice(0, 3);
    }
    return paper;
};
// The last filled shape before a text of a picture that contains its middle.
const groundOfText = (text) => {
    const box = text.getBoundingClientRect(), x = box.x + box.width / 2, y = box.y + box.height / 2;
    let found = null;
    for (const shape of text.ownerSVGElement.querySelectorAll('rect, circle')) {
        if (shape.compareDocumentPosition(text) & Node.DOCUMENT_POSITION_PRECEDING) break;
        const fill = getComputedStyle(shape).fill, own = shape.getBoundingClientRect();
        if (fill.startsWith('rgb') && own.x <= x && x <= own.right && own.y <= y && y <= own.bottom) found = number(fill).slice(0, 3);
    }
    return found ?? ground(text.ownerSVGElement);
};
// The boxes of all texts, one for each line of a text.
const boxes = [];
const walker = document.createTreeWalker(document.body, NodeFilter.SHOW_TEXT);
const sizes = new Map();
while (walker.nextNode()) {
    const node = walker.currentNode, element = node.parentElement;
    if (!node.data.trim() || element.closest('script, style, title, desc, option, .skip') || !visible(element)) continue;
    const style = getComputedStyle(element), isPicture = element.namespaceURI.endsWith('svg');
    const scale = isPicture ? element.getScreenCTM().a : 1;
    const size = parseFloat(style.fontSize) * scale;
    if (size < least - .05) say(`${size.toFixed(1)} px`, element);
    const ink = number(isPicture ? style.fill : style.color);
    const under = isPicture ? groundOfText(element) : ground(element);
    const alpha = (ink[3] ?? 1) * [...(function* () { for (let e = element; e; e = e.parentElement) yield Number(getComputedStyle(e).opacity); })()]
        .reduce((a, b) => a * b, 1);
    const mixed = ink.slice(0, 3).map((v, i) => v * alpha + under[i] * (1 - alpha));
    if (!element.closest('.permalink') && contrast(mixed, under) < leastContrast - .01) say(`contrast ${contrast(mixed, under).toFixed(1)}`, element);
    const range = document.createRange();
    range.selectNodeContents(node);
    for (const rect of isPicture ? [element.getBoundingClientRect()] : range.getClientRects()) {
        if (rect.width < 1 || rect.height < 1) continue;
        // The height of the letters, without the space above and below them.
        const middle = rect.y + rect.height / 2, half = Math.min(rect.height, size) * .36;
        boxes.push({element, x: rect.x, right: rect.right, y: middle - half, bottom: middle + half});
        if (isPicture) {
            const view = element.ownerSVGElement.getBoundingClientRect();
            if (rect.x < view.x - 1 || rect.right > view.right + 1 || rect.y < view.y - 2 || rect.bottom > view.bottom + 2) say('cut by its picture', element);
        }
        const box = element.closest('.scroll, .wide, nav, pre');
        const inside = box ? box.getBoundingClientRect() : {x: 0, right: innerWidth};
        if ((!box || isPaper) && (rect.x < inside.x - 1 || rect.right > inside.right + 1)) say('cut', element);
        if (box && !isPaper && box.scrollWidth > box.clientWidth + 1 && !['auto', 'scroll'].includes(getComputedStyle(box).overflowX)) say('cut by its box', element);
    }
}
boxes.sort((a, b) => a.y - b.y);
boxes.forEach((a, place) => {
    for (let i = place + 1; i < boxes.length && boxes[i].y < a.bottom - 1; i += 1) {
        const b = boxes[i];
        if (a.element === b.element || a.element.contains(b.element) || b.element.contains(a.element)) continue;
        const [box, other] = [a, b].map(({element}) => element.closest('.scroll, .wide, nav'));
        if (box !== other) continue;
        if (Math.min(a.right, b.right) - Math.max(a.x, b.x) > 1.5) say(`lies on “${b.element.textContent.trim().slice(0, 40)}”`, a.element);
    }
});
if (!isPaper && document.documentElement.scrollWidth > innerWidth) faults.push(`${document.documentElement.scrollWidth} pixels wide`);
for (const element of document.querySelectorAll('.scroll, .wide')) {
    if (visible(element) && element.scrollWidth > element.clientWidth + 1 && !isPaper
        && !(element.tabIndex === 0 && element.getAttribute('aria-label'))) faults.push(`a box that scrolls has no name or no tabindex: ${element.className}`);
}
for (const svg of document.querySelectorAll('figure svg[role=img]')) {
    if (!svg.querySelector(':scope > title')?.textContent || !svg.querySelector(':scope > desc')?.textContent) faults.push('a picture without a title or a description');
}
for (const table of document.querySelectorAll('table')) {
    if (!table.caption?.textContent.trim()) faults.push(`a table without a caption in ${table.closest('[id]')?.id}`);
}
return [...new Set(faults)];
"""


def words_of_sheets(browser):
    """Prints the open page; returns the number of words of each sheet."""
    printed = browser.devtools("Page.printToPDF", preferCSSPageSize=True)
    with tempfile.NamedTemporaryFile(suffix=".pdf") as file:
        file.write(base64.b64decode(printed["data"]))
        file.flush()
        text = subprocess.run(["pdftotext", "-layout", file.name, "-"], capture_output=True, text=True, check=True).stdout
    return [len(sheet.split()) for sheet in text.split("\f")[:-1]]


def check(browser, page):
    """Returns the faults of a page, each with where it was seen."""
    found = []
    browser.devtools("Emulation.setEmulatedMedia", media="screen")
    browser.open(page)
    paper = PAPER_WIDTHS[browser.run("return document.body.dataset.paper ?? 'portrait'")]
    words = words_of_sheets(browser)
    found += [(f"{page.name}, sheet {sheet + 1} of {len(words)}", f"only {count} words")
              for sheet, count in enumerate(words[:-1]) if count < FEWEST_WORDS]
    for media, width, theme in [*[("screen", width, theme) for width in WIDTHS for theme in ("light", "dark")],
                                ("print", paper, "light")]:
        browser.devtools("Emulation.setDeviceMetricsOverride", width=width, height=900, deviceScaleFactor=1, mobile=width < 500)
        browser.devtools("Emulation.setEmulatedMedia", media=media,
                         features=[{"name": "prefers-color-scheme", "value": theme}])
        if media == "screen":
            browser.run("for (const details of document.querySelectorAll('details')) details.open = true")
        else:
            browser.open(page)
            browser.run("dispatchEvent(new Event('beforeprint'))")
        faults = browser.run(FAULTS, LEAST_SIZE[media], LEAST_CONTRAST, media == "print")
        found += [(f"{page}, {media} of {width}, {theme}", fault) for fault in faults]
    found += [(str(page), entry["message"]) for entry in browser.log("browser") if entry["level"] != "INFO"]
    for entry in browser.log("performance"):
        message = json.loads(entry["message"])["message"]
        if message["method"] == "Network.requestWillBeSent":
            url = message["params"]["request"]["url"]
            if not re.match("file:|data:", url):
                found.append((str(page), f"requests {url}"))
    return found


def main():
    pages = [pathlib.Path(page).resolve(strict=True) for page in sys.argv[1:]]
    if not pages:
        sys.exit(__doc__)
    browser = Browser()
    try:
        found = [fault for page in pages for fault in check(browser, page)]
    finally:
        browser.close()
    for place, fault in found:
        print(f"{place}: {fault}")
    print(f"{len(pages)} pages, each at {len(WIDTHS)} widths, light and dark, and on paper: {len(found)} faults")
    sys.exit(bool(found))


if __name__ == "__main__":
    main()
