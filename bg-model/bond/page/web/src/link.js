// A link that holds the text. In: what is shown. Out: what stands after `#` of the address; and back. A text that is an
// example is named, another one is deflated (RFC 1951), in base64url (RFC 4648).

/** The largest text that a link is read for, characters: `bond` reads no larger one. */
const LARGEST = 8 << 20;

const through = (bytes, stream) => new Response(new Blob([bytes]).stream().pipeThrough(stream));

async function packed(text) {
  const bytes = new Uint8Array(await through(text, new CompressionStream("deflate-raw")).arrayBuffer());
  let letters = "";
  for (const byte of bytes) letters += String.fromCharCode(byte);
  return btoa(letters).replaceAll("+", "-").replaceAll("/", "_").replaceAll("=", "");
}

/** A text that was packed; a link may hold anything, so it is read as far as a text may go. */
async function unpacked(letters) {
  const plain = atob(letters.replaceAll("-", "+").replaceAll("_", "/"));
  const bytes = Uint8Array.from(plain, (letter) => letter.charCodeAt(0));
  const reader = through(bytes, new DecompressionStream("deflate-raw")).body.getReader();
  const decoder = new TextDecoder("utf-8", { fatal: true });
  let text = "";
  for (;;) {
    const { done, value } = await reader.read();
    if (done) return text + decoder.decode();
    text += decoder.decode(value, { stream: true });
    if (text.length > LARGEST) throw new Error("larger than any machine");
  }
}

/** What stands after `#`. */
export async function written({ text, graph, scene, t_end, step, inputs }, examples) {
  const example = examples.find((one) => one.text === text);
  const words = new URLSearchParams();
  if (example) words.set("example", example.name);
  else words.set("text", await packed(text));
  const usual = { scene: "", t_end: null, step: null, inputs: {}, ...example };
  if (graph) words.set("graph", graph);
  if (scene && scene !== usual.scene) words.set("scene", scene);
  if (t_end !== usual.t_end) words.set("end", t_end);
  if (step !== usual.step) words.set("step", step);
  if (!example) for (const [name, value] of Object.entries(inputs)) words.append("input", `${name}=${value}`);
  return words.toString();
}

/** What is shown at first. */
export async function read(words, examples) {
  const of = new URLSearchParams(words);
  const example = examples.find(({ name }) => name === of.get("example"));
  const number = (name) => (of.has(name) && Number.isFinite(Number(of.get(name))) ? Number(of.get(name)) : null);
  const inputs = of.getAll("input").map((word) => word.split("=")).map(([name, value]) => [name, Number(value)]);
  const packedText = of.get("text");
  const begin = packedText === null ? (example ?? examples[0]) : { text: await unpacked(packedText), scene: "" };
  return {
    text: begin.text,
    graph: of.get("graph"),
    scene: of.get("scene") ?? begin.scene,
    t_end: number("end") ?? begin.t_end ?? null,
    step: number("step") ?? begin.step ?? null,
    inputs: begin.inputs ?? Object.fromEntries(inputs.filter(([, value]) => Number.isFinite(value))),
  };
}
