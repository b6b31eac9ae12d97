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
import { element } from "./dom/element";

session.connection.open();
import("./page").catch((error: unknown) => {
  session.connection.end();
  const why = error instanceof Error ? error.message : String(error);
  document.body.prepend(element("p", { class: "unusable", role: "alert" }, `This browser cannot show the page: ${why}.`));
});
