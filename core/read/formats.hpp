#pragma once
/// The registry: one line per format. The rest of the line's life is generated: its declaration here, its place in
/// all_formats() in registry.cpp. Each format is defined in the file of its name.
#include "core/read/format.hpp"

// clang-format off
#define DRIFTLAB_FORMATS(FORMAT) \
  FORMAT(kCsv)      /* csv.cpp */       \
  FORMAT(kNpy)      /* npy.cpp */       \
  FORMAT(kNpz)      /* npz.cpp */       \
  FORMAT(kMat5)     /* mat5.cpp */      \
  FORMAT(kHdf5)     /* hdf5.cpp */      \
  FORMAT(kPhoneZip) /* phone_export.cpp */ \
  FORMAT(kCxd5602)  /* cxd5602.cpp */   \
  FORMAT(kVmu931)   /* vmu931.cpp */ \
  FORMAT(kUlog)     /* ulog.cpp */ \
  FORMAT(kMcap)     /* mcap.cpp */ \
  FORMAT(kRosbag)   /* rosbag.cpp */ \
  FORMAT(kDataflash) /* dataflash.cpp */ \
  FORMAT(kCwa)      /* cwa.cpp */ \
  FORMAT(kGeneactiv) /* geneactiv.cpp */ \
  FORMAT(kRosbag2)  /* rosbag2.cpp */ \
  FORMAT(kEuroc)    /* euroc.cpp */ \
  FORMAT(kEurocZip) /* euroc.cpp */ \
  FORMAT(kRostopic) /* rostopic.cpp */ \
  FORMAT(kKfGins)   /* kf_gins.cpp */ \
  FORMAT(kRtklibPos) /* rtklib_pos.cpp */ \
  FORMAT(kNmea)     /* nmea.cpp */ \
  FORMAT(kUbx)      /* ubx.cpp */ \
  FORMAT(kKitti)    /* kitti.cpp */
// clang-format on

namespace driftlab::formats {

#define DRIFTLAB_DECLARE_FORMAT(name) extern const Format name;
DRIFTLAB_FORMATS(DRIFTLAB_DECLARE_FORMAT)
#undef DRIFTLAB_DECLARE_FORMAT

}  // namespace driftlab::formats
