// The model inside the page: a WebAssembly module that answers orders.
// In: the compiled module. Out: a function from an order to its answer, JSON texts both (bg-workbench's `live`).

/** An instance of the module, with its program registered. */
async function instance(module) {
  const made = { exports: null, functions: 0 };
  ({ exports: made.exports } = await WebAssembly.instantiate(module, { env: machineCode(made) }));
  made.exports.main(0, 0);
  return made;
}

/**
 * What a module asks for that makes machine code of models (bg-native): another module is instantiated, with its memory
 * and its functions, and the function of that one gets a place in its table.
 */
function machineCode(made) {
  return {
    bg_native_instantiate(at, length) {
      const { memory, __indirect_function_table: table } = made.exports;
      try {
        const module = new WebAssembly.Module(new Uint8Array(memory.buffer, at, length));
        const { entry } = new WebAssembly.Instance(module, { env: made.exports }).exports;
        made.functions += 1;
        return table.grow(1, entry);
      } catch {
        // The program has an interpreter, too.
        return 0;
      }
    },
    bg_native_release(place) {
      made.exports.__indirect_function_table.set(place, null);
    },
  };
}

/** What answers orders, and how many functions of machine code have been made. After a trap a fresh instance answers. */
export async function answering(module) {
  let made = await instance(module);
  const answer = async (order) => {
    const { exports } = made;
    const text = new TextEncoder().encode(order);
    try {
      const at = exports.bg_live_reserve(text.length);
      new Uint8Array(exports.memory.buffer).set(text, at);
      const place = exports.bg_live_answer();
      return new TextDecoder().decode(new Uint8Array(exports.memory.buffer, place, exports.bg_live_length()));
    } catch (fault) {
      made = await instance(module);
      throw fault;
    }
  };
  return { answer, functions: () => made.functions };
}
