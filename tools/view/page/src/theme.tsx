// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Light or dark: as the system says, until the person says otherwise.

import { useValue, type Store } from './state';

export const systemIsDark = (): boolean => matchMedia('(prefers-color-scheme: dark)').matches;

export function applyTheme(store: Store): void {
  const apply = () => (document.documentElement.dataset.theme = store.get().dark ? 'dark' : 'light');
  apply();
  store.watch(apply);
  matchMedia('(prefers-color-scheme: dark)').addEventListener('change', (event) =>
    store.set({ dark: event.matches }));
}

export const flipTheme = (store: Store): void => store.set({ dark: !store.get().dark });

export function ThemeButton({ store }: { store: Store }) {
  const dark = useValue(store, (s) => s.dark);
  return (
    <button title="light or dark (l)" aria-label="light or dark" onClick={() => flipTheme(store)}>
      {dark ? '☀' : '☾'}
    </button>
  );
}
