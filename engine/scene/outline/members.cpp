#include "engine/scene/outline/members.hpp"

#include "engine/scene/description.hpp"
#include "engine/scene/saving/definition_json.hpp"
#include "engine/scene/saving/naming_keys.hpp"
#include "engine/scene/visitors/known_names.hpp"
#include "engine/scene/visitors/object_writer.hpp"
#include "engine/scene/visitors/value_text.hpp"

#include <algorithm>

namespace tumble {
namespace {

Member declared(const Parameter& p) {
  Member m;
  m.name = p.name;
  m.unit = p.unit;
  m.doc = p.doc;
  m.min = p.min;
  m.max = p.max;
  m.exclusive_min = p.exclusive_min;
  m.required = p.required;
  return m;
}

/// Fills in what kind of leaf it is.
struct LeafKind {
  Member& m;

  void operator()(const double*) const { m.kind = MemberKind::number; }
  void operator()(const Varying*) const {
    m.kind = MemberKind::number;
    m.varies = true;
  }
  void operator()(const VaryingVec3*) const {
    numbers(3);
    m.varies = true;
  }
  void operator()(const int*) const { m.kind = MemberKind::whole; }
  void operator()(const uint64_t*) const { m.kind = MemberKind::whole; }
  void operator()(const bool*) const { m.kind = MemberKind::truth; }
  void operator()(const std::string*) const {
    m.names = known_names(m.name);
    m.kind = m.names.empty() ? MemberKind::text : MemberKind::choice;
    if (m.names.empty()) m.refers_to = list_named_by(m.name);
  }
  void operator()(const Vec3*) const { numbers(3); }
  void operator()(const Quat*) const { numbers(4); }
  void operator()(const std::array<int, 3>*) const { numbers(3); }
  void operator()(const Colour*) const { m.kind = MemberKind::colour; }
  void operator()(const TickRate*) const { m.kind = MemberKind::rate; }
  void operator()(const EnumRef& value) const {
    m.kind = MemberKind::choice;
    m.names = value.type->names;
  }
  void operator()(const OptionalLeafRef& value) const { look(value.type->sample()); }
  void operator()(const LeafListRef& values) const {
    auto item = std::make_shared<Member>(m);
    item->required = true;
    LeafKind{*item}.look(values.type->sample());
    item->fallback = one_line(to_json(values.type->sample()));
    m.kind = MemberKind::values;
    m.item = std::move(item);
  }
  void look(const Leaf& leaf) const { std::visit(*this, static_cast<const Leaf::variant&>(leaf)); }

 private:
  void numbers(size_t size) const {
    m.kind = MemberKind::vector;
    m.size = size;
  }
};

class MemberVisitor final : public StructVisitor {
 public:
  explicit MemberVisitor(const JsonNode* object) : object_(object) {}

  void field(const Leaf& value, const Parameter& p) override {
    Member m = declared(p);
    LeafKind{m}.look(value);
    if (const Json usual = to_json(value); !usual.is_null()) m.fallback = one_line(usual);
    out_.push_back(std::move(m));
  }
  void object(const StructRef& value, const Parameter& p) override {
    put(p, MemberKind::object, value.type);
  }
  void object(const OptionalRef& value, const Parameter& p) override {
    put(p, MemberKind::object, value.type->item);
  }
  void list(const ListRef& values, const Parameter& p) override {
    put(p, MemberKind::list, values.type->item);
  }
  void map(const MapRef& values, const Parameter& p) override {
    put(p, MemberKind::map, values.type->item);
  }
  void one_of(const VariantRef& value, const Parameter& p) override {
    Member m = declared(p);
    m.kind = MemberKind::choice;
    m.selects = true;
    for (const StructType* type : value.type->alternatives) m.names.emplace_back(type->type_name);
    size_t chosen = value.type->index(value.variant);
    if (const JsonNode* said = object_ ? object_->find(p.name) : nullptr) {
      const auto found = std::ranges::find(m.names, said->string);
      if (found != m.names.end()) chosen = size_t(found - m.names.begin());
    }
    m.fallback = one_line(Json(m.names[chosen]));
    out_.push_back(std::move(m));
    show(*value.type->alternatives[chosen]);
  }
  void part(const StructRef& value) override { value.type->parameters(value.object, *this); }

  void show(const StructType& type) {
    part(StructRef{const_cast<void*>(type.defaults), &type});  // this visitor only looks
  }
  std::vector<Member> take() { return std::move(out_); }

 private:
  void put(const Parameter& p, MemberKind kind, const StructType* type) {
    Member m = declared(p);
    m.kind = kind;
    m.type = type;
    // A bare name may stand for a whole object: "material": "steel".
    if (kind == MemberKind::object && !type->shorthand_key.empty())
      m.refers_to = list_named_by(m.name);
    out_.push_back(std::move(m));
  }

  const JsonNode* object_;
  std::vector<Member> out_;
};

}  // namespace

std::string Member::range() const {
  if (!is_number() && kind != MemberKind::vector) return {};
  return range_text(bounded(
      {.name = name, .unit = unit, .min = min, .max = max, .exclusive_min = exclusive_min}));
}

std::vector<Member> members_of(const StructType& type, const JsonNode* object) {
  MemberVisitor visitor(object);
  visitor.show(type);
  return visitor.take();
}

Member scene_member() {
  Member m;
  m.name = "scene";
  m.doc = "all that the scene's file says";
  m.kind = MemberKind::object;
  m.type = &struct_type<SceneDescription>();
  return m;
}

}  // namespace tumble
