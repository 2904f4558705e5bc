// What can be measured on a page whose folded parts are all open: the facts of an Observation.

const ROUNDING = 1;  // CSS pixels by which boxes may differ
const LARGE_TEXT = 24, LARGE_BOLD_TEXT = 18.66;  // CSS pixels; WCAG 2.2, success criterion 1.4.3

const everything = [...document.body.querySelectorAll("*")];
const box = element => element.getBoundingClientRect();
const style = element => getComputedStyle(element);
const scrollBoxes = new Set(everything.filter(element => ["auto", "scroll"].includes(style(element).overflowX)));
const inScrollBox = element => element !== null && (scrollBoxes.has(element) || inScrollBox(element.parentElement));
const shown = element => element.checkVisibility({visibilityProperty: true, opacityProperty: true});
const drawn = element => box(element).width > 0 && box(element).height > 0;
const inPicture = element => element.ownerSVGElement != null;

function said(element) {
  const text = (element.getAttribute("alttext") || element.getAttribute("alt") || element.textContent).trim();
  return `<${element.localName} class="${element.getAttribute("class") || ""}"> ${text.slice(0, 60)}`;
}

const told = elements => elements.map(said);

// ---- widths ---------------------------------------------------------------------------------------------------

// The theme keeps its drawers beside the screen until they are opened.
const inDrawer = element => element.closest(".sidebar-drawer, .toc-drawer") !== null;

function wider(width) {
  const free = everything.filter(element => !inPicture(element) && !inDrawer(element) && shown(element)
    && !inScrollBox(element.parentElement));
  const far = told(free.filter(element => box(element).right > width + ROUNDING));
  return document.documentElement.scrollWidth > width ? [`the page: ${document.documentElement.scrollWidth}`, ...far] : far;
}

const cutOff = () => told(everything.filter(element => !inPicture(element) && shown(element)
  && ["hidden", "clip"].includes(style(element).overflowY) && element.scrollHeight > element.clientHeight + ROUNDING));

const scrolls = element => shown(element) && element.scrollWidth > element.clientWidth + ROUNDING;

// The browser itself lets the keyboard reach what scrolls, if nothing in it is reached already.
function reached(element) {
  if (element.tabIndex >= 0 || element.querySelector("a[href], button, input, select, summary")) return true;
  element.focus({preventScroll: true});
  return document.activeElement === element;
}

const outOfReach = () => told([...scrollBoxes].filter(element => scrolls(element) && !reached(element)));

// ---- stops of the keyboard that are none, formulas that the reader has to push about -----------------------------

const idleStops = () => told([...document.querySelectorAll("[tabindex='0']")].filter(element => !scrolls(element)));

const offScreen = () => told([...document.querySelectorAll(".formula")].filter(scrolls));

const TALLEST = 600;  // CSS pixels of a formula that is not folded

const towering = () => told([...document.querySelectorAll(".formula")]
  .filter(element => !element.closest("details.tall, details.lines") && box(element).height > TALLEST));

// ---- mathematics and pictures ---------------------------------------------------------------------------------

// Nothing can be set on paper.
const ofScreensOnly = element => matchMedia("print").matches && element.closest("form");

// Of a formula that is broken in two ways one is shown.
const eitherWay = element => element.closest(".wide, .narrow")?.parentElement ?? element;
const heads = "thead *";  // those of a folded table stand before its cells, as words
const flatMathematics = () => told([...document.querySelectorAll("math")]
  .filter(element => !drawn(eitherWay(element)) && !element.matches(heads) && !element.closest("[hidden]") && !ofScreensOnly(element)));

const brokenMathematics = () => told([...document.querySelectorAll("merror, math:empty")]);

const pictures = within => [...within.querySelectorAll("img, svg")].filter(element => !inPicture(element));
const loaded = picture => picture.localName !== "img" || picture.complete && picture.naturalWidth > 0;

// A figure may hold pictures of which the reader sees one at a time.
const emptyPictures = () => told([
  ...pictures(document).filter(picture => !loaded(picture) || shown(picture) && !drawn(picture)),
  ...[...document.querySelectorAll("figure")].filter(figure => !pictures(figure).some(drawn) && !ofScreensOnly(figure)),
]);

// ---- contrast -------------------------------------------------------------------------------------------------

const canvas = document.createElement("canvas").getContext("2d", {willReadFrequently: true});

function rgba(colour) {
  canvas.clearRect(0, 0, 1, 1);
  canvas.fillStyle = colour;
  canvas.fillRect(0, 0, 1, 1);
  const [red, green, blue, alpha] = canvas.getImageData(0, 0, 1, 1).data;
  return {channels: [red, green, blue], alpha: alpha / 255};
}

const over = (upper, lower) =>
  upper.channels.map((channel, place) => upper.alpha * channel + (1 - upper.alpha) * lower[place]);

const ground = element => element === null ? [255, 255, 255]
  : over(rgba(style(element).backgroundColor), ground(element.parentElement));

function luminance(channels) {
  const linear = channels.map(channel => channel / 255)
    .map(part => part <= 0.04045 ? part / 12.92 : ((part + 0.055) / 1.055) ** 2.4);
  return 0.2126 * linear[0] + 0.7152 * linear[1] + 0.0722 * linear[2];
}

function contrast(element) {
  const below = ground(element);
  const levels = [luminance(over(rgba(style(element).color), below)), luminance(below)].sort((a, b) => b - a);
  return (levels[0] + 0.05) / (levels[1] + 0.05);
}

function contrastWanted(element) {
  const size = parseFloat(style(element).fontSize), bold = style(element).fontWeight >= 700;
  return size >= LARGE_TEXT || (bold && size >= LARGE_BOLD_TEXT) ? 3 : 4.5;
}

const holdsText = element => [...element.childNodes].some(node => node.nodeType === Node.TEXT_NODE && node.data.trim());

const pale = () => everything.filter(element => holdsText(element) && shown(element) && !inPicture(element))
  .filter(element => contrast(element) < contrastWanted(element))
  .map(element => `${contrast(element).toFixed(2)}: ${said(element)}`);

// ---- the observation ------------------------------------------------------------------------------------------

document.querySelectorAll("details").forEach(each => { each.open = true; });

return {
  wider: wider(arguments[0]),
  cut_off: cutOff(),
  out_of_reach: outOfReach(),
  idle_stops: idleStops(),
  off_screen: offScreen(),
  towering: towering(),
  fonts: [...document.fonts].filter(font => font.status === "loaded").map(font => font.family),
  flat_mathematics: flatMathematics(),
  broken_mathematics: brokenMathematics(),
  empty_pictures: emptyPictures(),
  pale: pale(),
  links: [...document.links].map(link => link.href.baseVal ?? link.href),
  names: everything.map(element => element.id).filter(id => id),
};
