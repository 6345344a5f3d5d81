// SPDX-License-Identifier: Apache-2.0
//
// [Tanaka 2005] section 3: one doubly linked list of all nodes in drawing order. Each node knows first and last element
// of the sublists drawn before it (LL, LR) and after it (RL, RR); when the eye changes sides, the two sublists change
// places. Departures from the paper (docs/order.md): its four exchanges need both sublists, so here the stretch from LL
// to RR is taken out and put back as RL .. RR, node, LL .. LR, whichever are empty. The paper leaves changeParent()
// open. Here children come before their parents, and a node whose ends changed tells its parent, once a step. So a step
// touches no node twice, and no ancestor whose ends stay.
#include "order/sides.hpp"
#include "order/ways.hpp"

namespace kage::order {
namespace {

struct Element {
  std::uint32_t next = kNoNode;
  std::uint32_t prev = kNoNode;
  std::uint32_t ll = kNoNode;  // kNoNode in both: nothing is drawn before
  std::uint32_t lr = kNoNode;
  std::uint32_t rl = kNoNode;
  std::uint32_t rr = kNoNode;
  std::uint32_t parent = kNoNode;
};

class SwitchingList final : public VisibilityOrder {
 public:
  explicit SwitchingList(const TreeData& data) : data_(data), eye_(data) {}

  void move_to(const Eye& eye) override {
    eye_.set(eye);
    const std::uint64_t exact = eye_.exact();
    const bool first = list_.empty();
    step_ = {};
    step_.tests = OrderStep::Tests::all;
    if (first) make();
    for (const std::uint32_t v : switching_) {
      const bool front = eye_.front(v);
      if (front != front_[v]) {
        exchange(v);
        front_[v] = front;
        ++step_.flips;
      } else if (!moved_[v]) {
        continue;
      }
      moved_[v] = false;
      tell_parent(v);
    }
    step_.tested = switching_.size();
    step_.exact = eye_.exact() - exact;
    step_.change = step_.flips != 0 || first ? OrderStep::Change::exchange : OrderStep::Change::none;
    step_.why = "sublists of nodes whose side changed were exchanged";
    fresh_ = false;
  }

  [[nodiscard]] std::span<const std::uint32_t> order() override {
    if (!fresh_ && !list_.empty()) {
      order_.clear();
      order_.reserve(data_.nodes());
      for (std::uint32_t v = head_; v != kNoNode; v = list_[v].next) order_.push_back(v);
      fresh_ = true;
    }
    return order_;
  }

  [[nodiscard]] std::uint64_t bytes() const override {
    return tree_bytes(data_, false) + list_.size() * sizeof(Element) + front_.size() / 4 +
           (switching_.size() + order_.capacity()) * sizeof(std::uint32_t);
  }

 private:
  // As for an eye behind all planes: the side before a plane is drawn first, and by that the list is in order of
  // (first child, node, second child).
  void make() {
    const std::uint32_t n = data_.nodes();
    list_.resize(n);
    front_.assign(n, false);
    moved_.assign(n, false);
    if (n == 0) return;
    for (std::uint32_t v = 0; v < n; ++v) {
      for (const std::uint32_t c : {data_.first_child(v), data_.second_child(v)})
        if (c != kNoNode) list_[c].parent = v;
    }
    for (std::uint32_t v = n; v-- > 0;) {  // children before parents
      Element& e = list_[v];
      if (data_.size[v] > 1) switching_.push_back(v);  // a leaf's side is of no account
      if (const std::uint32_t c = data_.first_child(v); c != kNoNode) {
        e.ll = first_of(c);
        e.lr = last_of(c);
        link(e.lr, v);
      }
      if (const std::uint32_t c = data_.second_child(v); c != kNoNode) {
        e.rl = first_of(c);
        e.rr = last_of(c);
        link(v, e.rl);
      }
    }
    head_ = first_of(0);
  }

  [[nodiscard]] std::uint32_t first_of(std::uint32_t v) const { return list_[v].ll != kNoNode ? list_[v].ll : v; }
  [[nodiscard]] std::uint32_t last_of(std::uint32_t v) const { return list_[v].rr != kNoNode ? list_[v].rr : v; }

  void link(std::uint32_t p, std::uint32_t q) {
    if (p != kNoNode) list_[p].next = q;
    if (q != kNoNode) list_[q].prev = p;
  }

  void exchange(std::uint32_t v) {
    Element& e = list_[v];
    const std::uint32_t first = first_of(v);
    const std::uint32_t last = last_of(v);
    const std::uint32_t before = list_[first].prev;
    const std::uint32_t after = list_[last].next;
    std::swap(e.ll, e.rl);
    std::swap(e.lr, e.rr);
    link(before, first_of(v));
    if (e.ll != kNoNode) link(e.lr, v);
    if (e.rr != kNoNode) link(v, e.rl);
    link(last_of(v), after);
    if (before == kNoNode) head_ = first_of(v);
  }

  // The parent's ends of this stretch, if they are others now.
  void tell_parent(std::uint32_t v) {
    const std::uint32_t p = list_[v].parent;
    if (p == kNoNode) return;
    Element& e = list_[p];
    // The parent comes later, so its own two are still as its old side has them: the child before its plane is drawn
    // first if the eye is behind.
    const bool drawn_before = (v == p + 1) != front_[p];
    std::uint32_t& first = drawn_before ? e.ll : e.rl;
    std::uint32_t& last = drawn_before ? e.lr : e.rr;
    if (first == first_of(v) && last == last_of(v)) return;
    first = first_of(v);
    last = last_of(v);
    moved_[p] = true;
  }

  const TreeData& data_;
  EyeSides eye_;
  std::vector<Element> list_;
  std::vector<std::uint32_t> switching_;
  std::vector<bool> front_;
  std::vector<bool> moved_;  // the ends of a child's stretch changed in this step
  std::vector<std::uint32_t> order_;
  std::uint32_t head_ = kNoNode;
  bool fresh_ = false;
};

}  // namespace

std::unique_ptr<VisibilityOrder> make_switching_list(const TreeData& data) {
  return std::make_unique<SwitchingList>(data);
}

}  // namespace kage::order
