// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// What the browser runs first, while it still fetches and reads the rest of the page: asks for what
// takes long. The exported page does without.

import { address } from './api';
import { findMeans, type Means } from './graphics';

export interface Asked {
  session: Promise<Response>;
  means: Means;
}
declare global {
  interface Window {
    asked?: Asked;
  }
}

// The request goes out before the page waits for the card.
const session = fetch(address('api/session'));
session.catch(() => undefined); // is told to whoever takes it
window.asked = { session, means: findMeans() };
