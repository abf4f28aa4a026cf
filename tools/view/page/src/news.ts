// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// What the server told, in a component.

import { useEffect, useState } from 'preact/hooks';

export interface Newsroom {
  watch(listener: () => void): () => void;
}

export function useNews<T>(room: Newsroom, pick: () => T): T {
  const [, setCount] = useState(0);
  const picked = pick();
  useEffect(() => {
    if (pick() !== picked) setCount((n) => n + 1); // told before anybody listened
    return room.watch(() => setCount((n) => n + 1));
  }, [room]);
  return picked;
}
