#include <cstdio>
#include <fstream>
#include <memory>
#include "surface_cases.h"
using namespace isolux; using namespace isolux::bench;
static void put(std::ofstream& o, const SampleSet& s){
  std::int64_t n=(std::int64_t)s.size(); o.write((char*)&n,8);
  auto w=[&](const auto& v){ o.write((const char*)v.data(), (std::streamsize)(v.size()*sizeof(v[0])));};
  w(s.sites.positions); w(s.sites.isovalues); w(s.sites.normals); w(s.radiance); w(s.variance);
}
static void putvol(std::ofstream& o,const Volume& v, ValueRange r){
  Index3 s=v.lattice().size; o.write((char*)&s,sizeof s);
  o.write((char*)&v.lattice().frame.axes,sizeof(Mat3));
  o.write((char*)&r,sizeof r);
  for(int k=0;k<s.z;++k)for(int j=0;j<s.y;++j)for(int i=0;i<s.x;++i){float f=v.values(i,j,k);o.write((char*)&f,4);}
}
int main(int, char** argv){
  std::string mode=argv[1];
  int id=0;
  for(const Source& src: sources()){
    const Volume whole=read_volume(src.name); const Volume block=busiest_block(whole,src.isovalues);
    const ValueRange all=value_range(whole);
    std::vector<std::string> wanted;
    if(mode=="whole"){
      std::ofstream o("d/whole"+std::to_string(id++)+".bin",std::ios::binary); putvol(o,block,all);
      std::vector<SampleSet> refs;
      for(float h:src.isovalues){ auto p=surface_points(block,h,kPoints,11); if(p.size()<kPoints/4)continue; refs.push_back(trace(block,make_sites(block,std::move(p),{},{}),kReferenceRays,1000+refs.size()));}
      std::int64_t nr=(std::int64_t)refs.size(); o.write((char*)&nr,8); for(auto&r:refs)put(o,r);
      struct C{double t;double s;int r;const char* sm;}; 
      for(C c: {C{1,8,64,"stratified"},C{1,16,64,"stratified"},C{2,2,64,"stratified"},C{1,8,8,"stratified"},C{1,16,64,"level_sets"}}){
        Lattice tx=texels_of(block,c.t); SiteRequest q{.texels=tx}; auto sm=samplers().create(c.sm);
        Sites st=sm->sample(block,q,{.seed=3}); q.count=(std::size_t)(c.s*double(st.size())); st=sm->sample(block,q,{.seed=3});
        put(o,trace(block,std::move(st),c.r,5));
      }
    } else {
      float width=mode=="range"?0.1f:0.f; float half=.5f*width*(all.high-all.low);
      for(float h:src.isovalues){
        std::vector<float> levels{h}; if(half>0)levels={h-.8f*half,h,h+.8f*half};
        std::vector<SampleSet> refs;
        for(float l:levels){auto p=surface_points(block,l,kPoints,11); if(p.size()<kPoints/4)continue; refs.push_back(trace(block,make_sites(block,std::move(p),{},{}),kReferenceRays,1000+refs.size()));}
        if(refs.empty())continue;
        ValueRange rg{h-half,h+half};
        std::ofstream o("d/"+mode+std::to_string(id++)+".bin",std::ios::binary); putvol(o,block,rg);
        std::int64_t nr=(std::int64_t)refs.size(); o.write((char*)&nr,8); for(auto&r:refs)put(o,r);
        struct C{double t;double s;int r;};
        for(C c: {C{1,8,64},C{1,16,32},C{1,16,64},C{1,32,16},C{1,32,64}}){
          Lattice tx=texels_of(block,c.t); SiteRequest q{.texels=tx,.per_texel=c.s/std::pow(c.t,3),.isovalues=rg};
          put(o,trace(block,samplers().create("level_sets")->sample(block,q,{.seed=3}),c.r,5));
        }
      }
    }
    std::printf("%s %s\n",mode.c_str(),src.name.c_str()); std::fflush(stdout);
  }
}
