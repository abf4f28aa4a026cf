// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Words across the page: what went wrong, and that the server is gone.

import { useValue, type Store } from './state';

export function Notices({ store }: { store: Store }) {
  const gone = useValue(store, (s) => s.gone);
  const message = useValue(store, (s) => s.message);
  const faults = useValue(store, (s) => s.faults);
  return (
    <div class="notices" role="status">
      {gone && (
        <p class="bad">The server is gone: start <code>flocklift view</code> again and open the
          address that it prints. What is on the page stays; nothing more is saved.</p>
      )}
      {faults.length > 0 && !gone && (
        <p class="bad">{faults.join(' ')} Frames that are sound can be looked at.{' '}
          <button onClick={() => store.set({ faults: [] })}>close</button></p>
      )}
      {message && !gone && (
        <p class="bad">{message} <button onClick={() => store.set({ message: '' })}>close</button></p>
      )}
    </div>
  );
}
