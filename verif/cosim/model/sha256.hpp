// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <fmt/format.h>
#include <openssl/evp.h>

#include <array>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <string_view>

namespace kage::cosim {

/// A SHA-256, by OpenSSL.
class Sha256 {
 public:
  Sha256() : context_(EVP_MD_CTX_new(), EVP_MD_CTX_free) { start(); }

  /// Adds a text and its length, so that no two lists of texts are alike.
  void add(std::string_view text) {
    add(static_cast<std::uint64_t>(text.size()));
    EVP_DigestUpdate(context_.get(), text.data(), text.size());
  }
  void add(std::uint64_t number) { EVP_DigestUpdate(context_.get(), &number, sizeof number); }

  /// Adds values without their number: pieces of any size give what the whole gives.
  template <class T>
  void add_piece(std::span<const T> values) {
    EVP_DigestUpdate(context_.get(), values.data(), values.size_bytes());
  }

  /// The hash of all that was added, as 64 hexadecimal digits. The next one begins empty.
  std::string take() {
    std::array<unsigned char, EVP_MAX_MD_SIZE> digest{};
    unsigned size = 0;
    EVP_DigestFinal_ex(context_.get(), digest.data(), &size);
    std::string text;
    for (const unsigned char byte : std::span(digest).first(size)) text += fmt::format("{:02x}", byte);
    start();
    return text;
  }

 private:
  void start() { EVP_DigestInit_ex(context_.get(), EVP_sha256(), nullptr); }

  std::unique_ptr<EVP_MD_CTX, decltype(&EVP_MD_CTX_free)> context_;
};

}  // namespace kage::cosim
