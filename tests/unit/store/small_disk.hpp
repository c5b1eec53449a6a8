#pragma once
/// A file system of a few pages, so that a full disk is a test. Runs in a child process with its own mount table; needs
/// user namespaces (any user, on most kernels) or root.
#include <gtest/gtest.h>

#include <filesystem>
#include <functional>
#include <string>

namespace driftlab::server {

/// Runs `body(directory)` in a child process where `directory` is a fresh tmpfs of `bytes`. `body` returns an empty
/// text, or what went wrong. Gives that text; "skip: ..." where the system does not allow it.
std::string on_small_disk(std::size_t bytes, const std::function<std::string(const std::filesystem::path&)>& body);

}  // namespace driftlab::server
