// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Asks the server to do something to the running scene.

import { post } from './api';
import type { Store } from './state';

export const steer = (store: Store, body: unknown): void =>
  void post('api/steer', body).catch((error: unknown) => store.fail(error));
