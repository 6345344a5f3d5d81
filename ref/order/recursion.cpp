// SPDX-License-Identifier: Apache-2.0
//
// The reference: every node tested, every node walked, with a stack of its own.
#include "order/sides.hpp"
#include "order/ways.hpp"

namespace kage::order {
namespace {

class Recursion final : public VisibilityOrder {
 public:
  explicit Recursion(const TreeData& data) : data_(data), eye_(data), front_(data.nodes()) {
    order_.reserve(data.nodes());
  }

  void move_to(const Eye& eye) override {
    eye_.set(eye);
    const std::uint64_t exact = eye_.exact();
    step_ = {};
    step_.tested = data_.nodes();
    step_.why = "the whole tree is walked";
    for (std::uint32_t v = 0; v < data_.nodes(); ++v) {
      const bool front = eye_.front(v);
      if (front != front_[v]) ++step_.flips;
      front_[v] = front;
    }
    step_.exact = eye_.exact() - exact;
    walk();
  }

  [[nodiscard]] std::span<const std::uint32_t> order() override { return order_; }
  [[nodiscard]] std::uint64_t bytes() const override {
    return tree_bytes(data_, false) + order_.capacity() * sizeof(std::uint32_t) + front_.size() / 8;
  }

 private:
  void walk() {
    order_.clear();
    stack_.clear();
    // A node on the stack a second time has had its far side.
    const auto push = [&](std::uint32_t v, bool far_done) {
      if (v != kNoNode) stack_.push_back({v, far_done});
    };
    if (data_.nodes() != 0) push(0, false);
    while (!stack_.empty()) {
      const auto [v, far_done] = stack_.back();
      stack_.pop_back();
      const std::uint32_t before = data_.first_child(v);
      const std::uint32_t behind = data_.second_child(v);
      if (far_done) {
        order_.push_back(v);
        push(front_[v] ? before : behind, false);
      } else {
        push(v, true);
        push(front_[v] ? behind : before, false);
      }
    }
  }

  struct Entry {
    std::uint32_t node;
    bool far_done;
  };
  const TreeData& data_;
  EyeSides eye_;
  std::vector<bool> front_;
  std::vector<std::uint32_t> order_;
  std::vector<Entry> stack_;
};

}  // namespace

std::unique_ptr<VisibilityOrder> make_recursion(const TreeData& data) { return std::make_unique<Recursion>(data); }

}  // namespace kage::order
