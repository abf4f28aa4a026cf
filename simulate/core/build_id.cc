// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "simulate/core/build_id.h"

#include <elf.h>
#include <fmt/format.h>
#include <link.h>

#include <cstddef>
#include <string_view>
#include <utility>

namespace flocklift {
namespace {

// Notes stand one after the other: header, name, description, the latter two padded to 4 bytes.
std::string IdIn(const char* note, const char* end) {
  constexpr std::string_view kOwner("GNU\0", 4);
  const auto padded = [](std::size_t size) { return (size + 3) & ~std::size_t{3}; };
  while (end - note >= static_cast<std::ptrdiff_t>(sizeof(ElfW(Nhdr)))) {
    const auto* header = reinterpret_cast<const ElfW(Nhdr)*>(note);
    const char* name = note + sizeof *header;
    const std::size_t left = static_cast<std::size_t>(end - name);
    if (padded(header->n_namesz) + padded(header->n_descsz) > left) return {};
    const char* bytes = name + padded(header->n_namesz);
    if (header->n_type == NT_GNU_BUILD_ID && std::string_view(name, header->n_namesz) == kOwner) {
      std::string id;
      for (std::size_t k = 0; k < header->n_descsz; ++k) {
        id += fmt::format("{:02x}", static_cast<unsigned char>(bytes[k]));
      }
      return id;
    }
    note = bytes + padded(header->n_descsz);
  }
  return {};
}

// The program itself is visited first.
int TakeProgram(dl_phdr_info* program, std::size_t /*size*/, void* id) {
  for (int k = 0; k < program->dlpi_phnum; ++k) {
    const ElfW(Phdr)& part = program->dlpi_phdr[k];
    if (part.p_type != PT_NOTE) continue;
    // The loader tells addresses as numbers.
    const auto* note = reinterpret_cast<const char*>(  // NOLINT(performance-no-int-to-ptr)
        program->dlpi_addr + part.p_vaddr);
    std::string found = IdIn(note, note + part.p_memsz);
    if (found.empty()) continue;
    *static_cast<std::string*>(id) = std::move(found);
    break;
  }
  return 1;
}

}  // namespace

const std::string& BuildId() {
  static const std::string id = [] {
    std::string found;
    dl_iterate_phdr(TakeProgram, &found);
    return found;
  }();
  return id;
}

const std::string& ProgramIdentity() {
  static const std::string identity =
      fmt::format("flocklift {} build {}", FLOCKLIFT_VERSION, BuildId());
  return identity;
}

}  // namespace flocklift
