// The report in its frame.
// In: its HTML. Out: a frame with it, where the one before was being read: the same frame where the report is one of the
// same sections, charts and bodies, else another one that takes its place when it is there.

import { element } from "./elements.js";

/** The longest that is waited for a report to move: it may have no machine, its reader may want no motion. */
const PATIENCE = 1500;

/** Shows the report; the promise is kept when it moves. */
export async function show(pane, html) {
  const before = pane.querySelector("iframe:not(.next)");
  for (const frame of pane.querySelectorAll("iframe.next")) frame.remove();
  const renew = before?.contentWindow.renew;
  if (!renew || !(await renew(html).catch(() => false))) await replace(pane, before, html);
}

/** Shows the report in a frame that takes the place of `before`. */
function replace(pane, before, html) {
  const next = element("iframe", { class: "next", title: "Report" });
  pane.append(next);
  return new Promise((resolve) => {
    const arrive = () => {
      if (!next.isConnected) return;
      next.contentWindow.scrollTo(before?.contentWindow.scrollX ?? 0, before?.contentWindow.scrollY ?? 0);
      next.className = "";
      before?.remove();
      setTimeout(resolve, PATIENCE);
    };
    // Written rather than linked: its address is that of this page, so links to its sections and its files are right.
    const { contentDocument: document } = next;
    document.open();
    next.contentWindow.addEventListener("load", arrive, { once: true });
    next.contentWindow.addEventListener("moving", resolve, { once: true });
    document.write(html);
    document.close();
  });
}
