// The script of a page with a machine in motion, and the style of all pages.

import "uplot/dist/uPlot.min.css";
import "./style.css";
import "./view.css";
import "./charts.css";
import "./player.css";
import "./still.css";
import "./tuning.css";
import { begin } from "./main.js";
import { modes } from "./modes.js";
import { motion } from "./motion.js";
import { still } from "./still.js";

begin({ motion, modes, still });
