// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// The keyboard: one table of keys, what they do and the words for the help.

export interface Key {
  keys: string[]; // as KeyboardEvent.key, with "Shift+" or "Ctrl+" before it
  shown: string;
  text: string;
  group: string;
  act: (name: string) => void; // with that of `keys` which was pressed
  when?: () => boolean; // else it is left to those behind it
}

export function nameOf(event: KeyboardEvent): string {
  const key = event.key.length === 1 ? event.key.toLowerCase() : event.key;
  const ctrl = event.ctrlKey || event.metaKey ? 'Ctrl+' : '';
  const shift = event.shiftKey && (event.key.length > 1 || /[a-z]/i.test(event.key)) ? 'Shift+' : '';
  return ctrl + shift + key;
}

// Wherever the focus is: sliders that keep their keys to themselves hear of them later. While
// somebody types, only those that write nothing.
export function listenToKeys(keys: Key[]): void {
  addEventListener('keydown', (event) => {
    const target = event.target as HTMLElement;
    const types = target.matches('input:not([type=range]):not([type=checkbox]), textarea, select');
    const name = nameOf(event);
    // Within a panel they go to the next slider and press a button, as everywhere.
    if (/(Tab|Enter)$/.test(name) && !target.matches('body, canvas')) return;
    if (event.altKey || types && !/^(F\d+|Escape)$/.test(name)) return;
    const key = keys.find((k) => k.keys.includes(name) && (!k.when || k.when()));
    if (!key) return;
    event.preventDefault();
    if (target.matches('button, input, summary')) target.blur();
    key.act(name);
  }, { capture: true });
}
