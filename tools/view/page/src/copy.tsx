// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// A line to copy.

import { useState } from 'preact/hooks';

export function CopyLine({ text }: { text: string }) {
  const [copied, setCopied] = useState(false);
  const copy = async () => {
    try {
      await navigator.clipboard.writeText(text);
      setCopied(true);
      setTimeout(() => setCopied(false), 1200);
    } catch {
      // the text can still be marked
    }
  };
  return (
    <div class="line">
      <code>{text}</code>
      <button onClick={() => void copy()}>{copied ? 'copied' : 'copy'}</button>
    </div>
  );
}
