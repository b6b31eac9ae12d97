// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

// What the browser reads first, and it is little: the server is asked for its field while the rest of
// the page is still on its way.
import "uplot/dist/uPlot.min.css";
import "./style/tokens.css";
import "./style/layout.css";
import "./style/controls.css";
import "./style/panels.css";
import { session } from "./app/live_session";

session.connection.open();
void import("./page");
