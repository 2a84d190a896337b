#include "technique.hpp"
#include <gl_context.hpp>
#include <cstdio>
int main(int n, char** w){
  try {
  OffscreenContext c(0);
  Scene scene = n>1? load_glb(w[1],0.05f): make_scene(1024);
    Settings s; s.width=480; s.height=270;
  Stage stage(scene, c.glsl());
  s.exposure = 1.0f;
  std::vector<std::uint8_t> ref;
  for (int samples : {1,4,2,8}) {
  s.samples=samples; ref.clear();
  for (const Technique& t : {forward_every_light(), tiled_forward(), tiled_forward_pre_z(ZEnds::none,Reduction::cpu), tiled_forward_pre_z(ZEnds::both,Reduction::cpu), tiled_forward_pre_z(ZEnds::both,Reduction::gpu), tiled_forward_box(), tiled_deferred(16), tiled_deferred(32), tiled_deferred_passes(32), tiled_deferred_kernel(32), deferred(16), deferred(32), deferred_stencil(16), deferred_stencil(32), light_indexed(16), clustered_forward(), z_binned_forward()}) {
    if (samples>1 && !t.multisampled) continue;
    stage.memory.clear();
    s.wide = t.g_buffer_bits==32;
    double ms[2];std::vector<Pass> p;
    for (int i=0;i<2;++i){ s.count=false; stage.begin(scene.cameras[0], s); t.draw(stage); stage.lap("resolve"); p=stage.end(); ms[i]=0; for(auto&x:p) ms[i]+=x.milliseconds; }
    auto pic = stage.read_picture();
    s.count=true; stage.begin(scene.cameras[0], s); t.draw(stage); stage.end(); { extern void dump(const char*, int,int,const std::vector<std::uint8_t>&); dump(t.name.c_str(), s.width,s.height, pic);}
    if(ref.empty()) ref=pic;
    int worst=0; size_t diff=0; for(size_t i=0;i<pic.size();++i){int d=std::abs(pic[i]-ref[i]); if (i%4<3){worst=std::max(worst,d); diff+=d>0;}}
    std::printf("%-40s %2d %8.2f ms %8.2f MB %10.3f evals/pixel diff %zu worst %d |", t.name.c_str(), t.g_buffer_bits, ms[1], stage.memory.bytes()/1e6, double(stage.evaluations())/s.width/s.height, diff, worst);
    for(auto&x:p) std::printf(" %s %.2f", x.name.c_str(), x.milliseconds); std::printf("\n");
  }}
  { s.samples=1; s.transparent=true; ref.clear(); for (const Technique& t : {forward_every_light(), transparent_forward(TransparentLists::max_only), transparent_forward(TransparentLists::shared), transparent_forward(TransparentLists::own_min)}) {     stage.memory.clear();
    s.wide = t.g_buffer_bits==32;
    double ms[2];std::vector<Pass> p;
    for (int i=0;i<2;++i){ s.count=false; stage.begin(scene.cameras[0], s); t.draw(stage); stage.lap("resolve"); p=stage.end(); ms[i]=0; for(auto&x:p) ms[i]+=x.milliseconds; }
    auto pic = stage.read_picture();
    s.count=true; stage.begin(scene.cameras[0], s); t.draw(stage); stage.end(); { extern void dump(const char*, int,int,const std::vector<std::uint8_t>&); dump(t.name.c_str(), s.width,s.height, pic);}
    if(ref.empty()) ref=pic;
    int worst=0; size_t diff=0; for(size_t i=0;i<pic.size();++i){int d=std::abs(pic[i]-ref[i]); if (i%4<3){worst=std::max(worst,d); diff+=d>0;}}
    std::printf("%-40s %2d %8.2f ms %8.2f MB %10.3f evals/pixel diff %zu worst %d |", t.name.c_str(), t.g_buffer_bits, ms[1], stage.memory.bytes()/1e6, double(stage.evaluations())/s.width/s.height, diff, worst);
    for(auto&x:p) std::printf(" %s %.2f", x.name.c_str(), x.milliseconds); std::printf("\n");
 }}
 { s.transparent=false; s.three_shaders=true; ref.clear(); for (const Technique& t : {forward_every_light(), tiled_forward_pre_z(ZEnds::both,Reduction::gpu), tiled_deferred(32)}) {     stage.memory.clear();
    s.wide = t.g_buffer_bits==32;
    double ms[2];std::vector<Pass> p;
    for (int i=0;i<2;++i){ s.count=false; stage.begin(scene.cameras[0], s); t.draw(stage); stage.lap("resolve"); p=stage.end(); ms[i]=0; for(auto&x:p) ms[i]+=x.milliseconds; }
    auto pic = stage.read_picture();
    s.count=true; stage.begin(scene.cameras[0], s); t.draw(stage); stage.end(); { extern void dump(const char*, int,int,const std::vector<std::uint8_t>&); dump(t.name.c_str(), s.width,s.height, pic);}
    if(ref.empty()) ref=pic;
    int worst=0; size_t diff=0; for(size_t i=0;i<pic.size();++i){int d=std::abs(pic[i]-ref[i]); if (i%4<3){worst=std::max(worst,d); diff+=d>0;}}
    std::printf("%-40s %2d %8.2f ms %8.2f MB %10.3f evals/pixel diff %zu worst %d |", t.name.c_str(), t.g_buffer_bits, ms[1], stage.memory.bytes()/1e6, double(stage.evaluations())/s.width/s.height, diff, worst);
    for(auto&x:p) std::printf(" %s %.2f", x.name.c_str(), x.milliseconds); std::printf("\n");
 }}
  } catch (std::exception& e) { std::printf("%s\n", e.what()); return 1;}
}

#include <picture.hpp>
void dump(const char* n, int w, int h, const std::vector<std::uint8_t>& p){ Picture q{w,h,{}}; for(size_t i=0;i<p.size();++i) if(i%4!=3) q.rgb.push_back(p[i]); write_png(q, std::string("/tmp/pic_")+n+".png"); }
