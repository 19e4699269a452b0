SHARED_FILES += \
	shared/chain/chain.h \
	shared/chain/chain_light.h \
	shared/chain/chain_numbers.h \
	shared/chain/mutation.h \
	shared/chain/pool.h \
	shared/chain/shift.h
