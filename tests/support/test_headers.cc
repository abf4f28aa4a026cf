// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Nothing but what tests/CMakeLists.txt puts before it, compiled once for all tests.
