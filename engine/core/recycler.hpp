#pragma once
#include <cstddef>
#include <cstdint>
#include <memory>
#include <mutex>
#include <utility>
#include <vector>

namespace tumble {

/// Makes shared objects, reusing those that nobody holds any more, with all the memory that they
/// own and that of the shared_ptr's control block. Objects may outlive the recycler, and the last
/// holder may be on any thread.
template <class T>
class Recycler {
 public:
  /// Keeps at most so many unused objects.
  explicit Recycler(size_t most = 4) : store_(std::make_shared<Store>()) { keep_at_most(most); }
  void keep_at_most(size_t most) {
    const std::lock_guard lock(store_->mutex);
    store_->most = most;
    store_->idle.reserve(most);
  }

  /// An object in the state in which its last holder left it, or a new one.
  std::shared_ptr<T> get() {
    std::unique_ptr<Node> node = store_->take();
    if (!node) node = std::make_unique<Node>();
    T* const value = &node->value;
    return std::shared_ptr<T>(value, StaysInNode{}, Place<T>{store_, node.release()});
  }

 private:
  /// Size of the control block of a shared_ptr with deleter and allocator [bytes].
  static constexpr size_t counts_size = 96;

  struct Node {
    T value{};
    alignas(std::max_align_t) std::byte counts[counts_size];
  };
  struct Store {
    std::mutex mutex;
    std::vector<std::unique_ptr<Node>> idle;
    size_t most = 0;

    std::unique_ptr<Node> take() {
      const std::lock_guard lock(mutex);
      if (idle.empty()) return nullptr;
      std::unique_ptr<Node> node = std::move(idle.back());
      idle.pop_back();
      return node;
    }
    void put_back(std::unique_ptr<Node> node) {
      const std::lock_guard lock(mutex);
      if (idle.size() < most) idle.push_back(std::move(node));
    }
  };
  struct StaysInNode {
    void operator()(T*) const {}
  };
  /// Allocates the control block inside the node, which is free for reuse when the block is
  /// released.
  template <class U>
  struct Place {
    using value_type = U;
    std::shared_ptr<Store> store;
    Node* node = nullptr;

    Place(std::shared_ptr<Store> s, Node* n) : store(std::move(s)), node(n) {}
    template <class V>
    Place(const Place<V>& other) : store(other.store), node(other.node) {}
    U* allocate(size_t) {
      static_assert(sizeof(U) <= counts_size && alignof(U) <= alignof(std::max_align_t));
      return reinterpret_cast<U*>(node->counts);
    }
    void deallocate(U*, size_t) { store->put_back(std::unique_ptr<Node>(node)); }
    template <class V>
    bool operator==(const Place<V>& other) const {
      return node == other.node;
    }
  };

  std::shared_ptr<Store> store_;
};

}  // namespace tumble
