// The first script of a page: unpacks the texts that stand in it as base64 of deflated UTF-8, and starts the script
// among them. Not bundled; `src/page/mod.rs` writes it into the page as it is.
const inflated = (id, page = document) => {
  const text = page.getElementById(id).textContent;
  const bytes = Uint8Array.from(atob(text), (letter) => letter.charCodeAt(0));
  return new Response(new Blob([bytes]).stream().pipeThrough(new DecompressionStream("deflate-raw")));
};
const unpacked = (id, page) => inflated(id, page).text();
const unpackedBytes = (id) => inflated(id).arrayBuffer();
/** What starts a worker with the model of a live page. */
const model = async () => {
  const [script, bytes] = await Promise.all([unpacked("worker"), unpackedBytes("module")]);
  const address = URL.createObjectURL(new Blob([script], { type: "text/javascript" }));
  return () => {
    const worker = new Worker(address);
    worker.postMessage(bytes);
    return worker;
  };
};
/** Whether the machine moves before anybody asks for it. */
const plays = false;
// Who prints the page, tests it or takes a picture of it waits until it is done: a frame whose document is open keeps
// it from being loaded.
const hold = document.body.appendChild(document.createElement("iframe"));
hold.setAttribute("hidden", "");
hold.contentDocument.open();
unpacked("script").then(
  (text) => {
    const script = document.createElement("script");
    script.textContent = text;
    document.body.append(script);
  },
  (fault) => {
    hold.contentDocument.close();
    document.getElementById("charts").append(`Charts and motion need a browser of 2023 or later: ${fault.message}`);
  },
);
