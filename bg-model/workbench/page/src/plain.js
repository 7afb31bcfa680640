// The script of a page without a machine: without three.js a tenth of the size.

import { begin } from "./main.js";

begin({});
