#include "viewer/context/backends.hpp"
#include "viewer/context/shared_library.hpp"

#include <array>
#include <cstdint>

namespace tumble {
namespace {

// The declarations of GL/osmesa.h that are used, so that its package is not needed to build.
constexpr int osmesa_format = 0x22, osmesa_profile = 0x33, osmesa_core_profile = 0x34,
              osmesa_major = 0x36, osmesa_minor = 0x37, osmesa_depth_bits = 0x30;
constexpr int gl_rgba = 0x1908;
constexpr unsigned gl_unsigned_byte = 0x1401;

struct OsMesa {
  using Context = void*;
  Context (*create_context_attribs)(const int* attributes, Context share) = nullptr;
  void (*destroy_context)(Context) = nullptr;
  unsigned char (*make_current)(Context, void* buffer, unsigned type, int width,
                                int height) = nullptr;
  GlContext::Function (*get_proc_address)(const char* name) = nullptr;
};

class OsMesaContext final : public GlContext {
 public:
  explicit OsMesaContext(const OsMesa& osmesa) : osmesa_(osmesa) {
    info_.name = "osmesa";
    info_.detail = "libOSMesa.so.8";
  }
  ~OsMesaContext() override {
    if (!context_) return;
    release();
    osmesa_.destroy_context(context_);
  }

  Status open() {
    const std::array<int, 11> attributes = {osmesa_format,
                                            gl_rgba,
                                            osmesa_depth_bits,
                                            0,
                                            osmesa_profile,
                                            osmesa_core_profile,
                                            osmesa_major,
                                            3,
                                            osmesa_minor,
                                            3,
                                            0};
    context_ = osmesa_.create_context_attribs(attributes.data(), nullptr);
    if (!context_)
      return Error{ErrorCode::unsupported, "OSMesa makes no OpenGL 3.3 core context", "osmesa",
                   "apt install libosmesa6"};
    if (Status s = make_current(); !s) return s;
    return describe_current(*this, info_);
  }

  const ContextInfo& info() const override { return info_; }
  Status make_current() override {
    if (!osmesa_.make_current(context_, dummy_.data(), gl_unsigned_byte, side, side))
      return Error{ErrorCode::unsupported, "OSMesaMakeCurrent failed", "osmesa",
                   "apt install --reinstall libosmesa6"};
    return {};
  }
  void release() override { osmesa_.make_current(nullptr, nullptr, 0, 0, 0); }
  Function get_proc_address(const char* name) const override {
    return osmesa_.get_proc_address(name);
  }

 private:
  static constexpr int side = 16;  // OSMesa requires an image buffer; nothing is drawn into it
  OsMesa osmesa_;
  OsMesa::Context context_ = nullptr;
  std::array<uint32_t, size_t(side) * side> dummy_{};
  ContextInfo info_;
};

}  // namespace

Result<std::unique_ptr<GlContext>> make_osmesa_context() {
  auto library = SharedLibrary::open("libOSMesa.so.8", "apt install libosmesa6");
  if (!library) return library.error();
  OsMesa o;
  if (!library->find("OSMesaCreateContextAttribs", o.create_context_attribs) ||
      !library->find("OSMesaDestroyContext", o.destroy_context) ||
      !library->find("OSMesaMakeCurrent", o.make_current) ||
      !library->find("OSMesaGetProcAddress", o.get_proc_address))
    return Error{ErrorCode::unsupported, "too old: no OSMesaCreateContextAttribs", "libOSMesa.so.8",
                 "apt install libosmesa6"};
  auto context = std::make_unique<OsMesaContext>(o);
  if (Status s = context->open(); !s) return s.error();
  return std::unique_ptr<GlContext>(std::move(context));
}

}  // namespace tumble
