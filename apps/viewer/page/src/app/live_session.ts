// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

// The server that this page came from.
import { Session } from "../protocol/session";

const address = new URL("ws", location.href);
address.protocol = location.protocol === "https:" ? "wss:" : "ws:";

export const session = new Session(address.href, new URLSearchParams(location.search).get("token"));
