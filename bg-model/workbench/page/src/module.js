// The model inside the page: a WebAssembly module that answers orders.
// In: the compiled module. Out: a function from an order to its answer, JSON texts both (bg-workbench's `live`).

/** An instance of the module, with its program registered. */
async function instance(module) {
  const { exports } = await WebAssembly.instantiate(module, {});
  exports.main(0, 0);
  return exports;
}

/** What answers orders. After a trap a fresh instance answers the next one. */
export async function answering(module) {
  let exports = await instance(module);
  return async (order) => {
    const text = new TextEncoder().encode(order);
    try {
      const at = exports.bg_live_reserve(text.length);
      new Uint8Array(exports.memory.buffer).set(text, at);
      const answer = exports.bg_live_answer();
      return new TextDecoder().decode(new Uint8Array(exports.memory.buffer, answer, exports.bg_live_length()));
    } catch (fault) {
      exports = await instance(module);
      throw fault;
    }
  };
}
