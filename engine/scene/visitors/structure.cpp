#include "engine/scene/visitors/structure.hpp"

#include "engine/scene/description.hpp"
#include "engine/scene/description/part.hpp"

namespace tumble {
namespace {

template <class T>
struct TypeOf;  // of a member: the kind of reference that is passed on

Leaf leaf_of(auto& value) {
  return TypeOf<std::remove_reference_t<decltype(value)>>::leaf(value);
}

template <class T>
struct TypeOf {
  static Leaf leaf(T& value) { return Leaf(&value); }
};

template <class E>
requires std::is_enum_v<E>
struct TypeOf<E> {
  static size_t get(const void* value) {
    const E e = *static_cast<const E*>(value);
    size_t i = 0;
    for (const auto& [name, v] : EnumNames<E>::values) {
      if (v == e) break;
      ++i;
    }
    return i;
  }
  static void set(void* value, size_t place) {
    *static_cast<E*>(value) = EnumNames<E>::values[place].second;
  }
  static Leaf leaf(E& value) {
    static const EnumType type = [] {
      EnumType made{{}, &get, &set};
      for (const auto& [name, v] : EnumNames<E>::values) made.names.emplace_back(name);
      return made;
    }();
    return Leaf(EnumRef{&value, &type});
  }
};

template <class T>
Leaf sample_of() {
  static T value{};
  return leaf_of(value);
}

template <class T>
struct TypeOf<std::optional<T>> {
  using Option = std::optional<T>;
  static bool has(const void* option) { return static_cast<const Option*>(option)->has_value(); }
  static Leaf get(void* option) { return leaf_of(**static_cast<Option*>(option)); }
  static Leaf emplace(void* option) { return leaf_of(static_cast<Option*>(option)->emplace()); }
  static Leaf leaf(Option& value) {
    static constexpr OptionalLeafType type{&has, &get, &emplace, &sample_of<T>};
    return Leaf(OptionalLeafRef{&value, &type});
  }
  static void* get_struct(void* option) { return &**static_cast<Option*>(option); }
  static void* emplace_struct(void* option) { return &static_cast<Option*>(option)->emplace(); }
};

template <class T>
struct TypeOf<std::vector<T>> {
  using List = std::vector<T>;
  static size_t size(const void* list) { return static_cast<const List*>(list)->size(); }
  static Leaf at(void* list, size_t i) { return leaf_of((*static_cast<List*>(list))[i]); }
  static void clear(void* list) { static_cast<List*>(list)->clear(); }
  static Leaf append(void* list) { return leaf_of(static_cast<List*>(list)->emplace_back()); }
  static Leaf leaf(List& value) {
    static constexpr LeafListType type{&size, &at, &clear, &append, &sample_of<T>};
    return Leaf(LeafListRef{&value, &type});
  }
  static void* struct_at(void* list, size_t i) { return &(*static_cast<List*>(list))[i]; }
  static void* append_struct(void* list) { return &static_cast<List*>(list)->emplace_back(); }
  static void reserve(void* list, size_t count) { static_cast<List*>(list)->reserve(count); }
};

template <class T>
struct TypeOf<NamedList<T>> {
  using Map = NamedList<T>;
  static size_t size(const void* map) { return static_cast<const Map*>(map)->size(); }
  static const std::string& name(const void* map, size_t i) {
    return static_cast<const Map*>(map)->items[i].name;
  }
  static void* at(void* map, size_t i) { return &static_cast<Map*>(map)->items[i].value; }
  static void* add(void* map, const std::string& name) {
    return &static_cast<Map*>(map)->add(name);
  }
};

template <class... Ts>
struct TypeOf<std::variant<Ts...>> {
  using Variant = std::variant<Ts...>;
  static size_t index(const void* variant) { return static_cast<const Variant*>(variant)->index(); }
  static void* get(void* variant) {
    return std::visit([](auto& v) -> void* { return &v; }, *static_cast<Variant*>(variant));
  }
  template <class T>
  static void* make(Variant& variant) {
    return &variant.template emplace<T>();
  }
  static void* emplace(void* variant, size_t alternative) {
    static constexpr void* (*makers[])(Variant&) = {&make<Ts>...};
    return makers[alternative](*static_cast<Variant*>(variant));
  }
};

/// The visitor with which parameters() of all structs is instantiated (type erasure).
class Eraser {
 public:
  explicit Eraser(StructVisitor& to) : to_(to) {}

  template <class T>
  void field(T& value, const Parameter& p) {
    to_.field(leaf_of(value), p);
  }
  template <class T>
  void object(T& value, const Parameter& p) {
    to_.object(StructRef{&value, &struct_type<T>()}, p);
  }
  template <class T>
  void object(std::optional<T>& value, const Parameter& p) {
    using Of = TypeOf<std::optional<T>>;
    static const OptionalType type{&struct_type<T>(), &Of::has, &Of::get_struct,
                                   &Of::emplace_struct};
    to_.object(OptionalRef{&value, &type}, p);
  }
  template <class T>
  void list(std::vector<T>& values, const Parameter& p) {
    using Of = TypeOf<std::vector<T>>;
    static const ListType type{&struct_type<T>(), &Of::size, &Of::struct_at, &Of::append_struct,
                               &Of::reserve};
    to_.list(ListRef{&values, &type}, p);
  }
  template <class T>
  void map(NamedList<T>& values, const Parameter& p) {
    using Of = TypeOf<NamedList<T>>;
    static const MapType type{&struct_type<T>(), &Of::size, &Of::name, &Of::at, &Of::add};
    to_.map(MapRef{&values, &type}, p);
  }
  template <class... Ts>
  void one_of(std::variant<Ts...>& value, const Parameter& p) {
    using Of = TypeOf<std::variant<Ts...>>;
    static const VariantType type{{&struct_type<Ts>()...}, &Of::index, &Of::get, &Of::emplace};
    to_.one_of(VariantRef{&value, &type}, p);
  }
  template <class T>
  void part(T& value) {
    to_.part(StructRef{&value, &struct_type<T>()});
  }

 private:
  StructVisitor& to_;
};

template <class T>
void show_parameters(void* object, StructVisitor& visitor) {
  Eraser eraser(visitor);
  T::parameters(eraser, *static_cast<T*>(object));
}

template <class T>
StructType make_struct_type() {
  static const T defaults{};
  StructType out{{}, {}, {}, &defaults, &show_parameters<T>, nullptr};
  if constexpr (requires { T::schema_name; }) out.schema_name = T::schema_name;
  if constexpr (requires { T::shorthand_key; }) out.shorthand_key = T::shorthand_key;
  if constexpr (
      requires { T::type_name; } || requires { T::type_name(); })
    out.type_name = type_name_of<T>();
  if constexpr (requires(const T& d, Complaints& c) { T::check(d, c); })
    out.check = [](const void* object, Complaints& c) {
      T::check(*static_cast<const T*>(object), c);
    };
  return out;
}

}  // namespace

template <class T>
const StructType& struct_type() {
  static const StructType type = make_struct_type<T>();
  return type;
}

// The top-level structs; through them all structs that are part of these are instantiated.
template const StructType& struct_type<SceneDescription>();
template const StructType& struct_type<RobotsOfScene>();
template const StructType& struct_type<BodyDescription>();
template const StructType& struct_type<CopyDescription>();
template const StructType& struct_type<DrawnDescription>();
template const StructType& struct_type<DriveDescription>();
template const StructType& struct_type<EmitterDescription>();
template const StructType& struct_type<ForceDescription>();
template const StructType& struct_type<JointDescription>();
template const StructType& struct_type<MaterialDescription>();
template const StructType& struct_type<ParameterDescription>();
template const StructType& struct_type<ParticleSystemDescription>();
template const StructType& struct_type<SensorDescription>();
template const StructType& struct_type<WorldSettings>();

}  // namespace tumble
