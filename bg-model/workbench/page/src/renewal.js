// Another report in the place of the one that is shown.
// In: its document with its data. Out: whether it is one of the same kind; this page with its texts.

/** The sections that are taken over as they are written. */
const WRITTEN = ["modes", "statements", "figures", "parameters", "statistics", "equations"];

/** What two reports have in common where one can take the place of the other. */
function kind(page, { charts, balance, animation, modes }) {
  const named = ({ title, unit, curves }) => [title, unit, ...curves.map(({ name }) => name)];
  const body = ({ name, points }) => [name, ...points.map((point) => point.name)];
  const sections = [...page.querySelectorAll("main section[id]")].map(({ id }) => id);
  const bodies = animation?.bodies.map(body) ?? null;
  return JSON.stringify([sections, charts.map(named), balance.map(named), bodies, modes === null]);
}

/** Whether reports, each a document with its data, have the same sections, charts and bodies. */
export function isOfOneKind(own, other) {
  return kind(...own) === kind(...other);
}

/** The picture of the graph as it was written: what the reader does with it changes its elements. */
let picture = document.querySelector("#picture .picture")?.innerHTML;

/** Brings all over from `page` that no script makes; whether the picture of the graph is another one. */
export function bringOver(page) {
  document.title = page.title;
  const both = (selector) => [document, page].map((of) => of.querySelector(selector));
  const replace = ([own, other]) => own?.replaceWith(other);
  replace(both("header"));
  for (const name of WRITTEN) {
    const sections = both(`#${name}`);
    const folded = sections.map((section) => section?.querySelector("details"));
    if (folded[0]?.open) folded[1].open = true;
    replace(sections);
  }
  for (const selector of ["#samples", "#balance > p"]) {
    const [own, other] = both(selector);
    if (own) own.textContent = other.textContent;
  }
  const pictures = both("#picture");
  const drawn = pictures[1]?.querySelector(".picture").innerHTML;
  if (drawn === picture) return false;
  picture = drawn;
  replace(pictures);
  return true;
}
